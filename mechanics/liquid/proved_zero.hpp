#pragma once

#include "mechanics/liquid/liquid_scene.hpp"

namespace mechanics::liquid {

/// Whether it is shown by intervals that p = 0 everywhere: h <= 0 in the domain, no pressure on free parts,
/// and walls that leave no slower than F drives the liquid at them, a >= |F|. Then 0 is a supersolution, and
/// the least that p >= 0 allows.
bool is_proved_zero(const LiquidScene&);

}  // namespace mechanics::liquid
