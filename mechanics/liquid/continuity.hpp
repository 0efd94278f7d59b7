#pragma once

#include "mechanics/liquid/liquid_scene.hpp"

namespace mechanics::liquid {

/// Throws InvalidInput where, along lines through the domain, a component of the velocity jumps, or one of
/// the force along its own axis: what they would add to h lies on a surface, and the derivatives of the text,
/// which are those of the branch taken, do not have it. Kinks are allowed: h jumps there.
void require_continuous(const LiquidScene&);

}  // namespace mechanics::liquid
