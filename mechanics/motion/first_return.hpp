#pragma once

#include "mechanics/motion/orbit.hpp"

namespace mechanics::inline motions {

/// The time after which the motion from a state comes near it again, up to the multiples of `modulo`: a first
/// guess of a free period; 0 if it does not. Near is half of how far it was away, or less. It is there where
/// it comes to the plane through the state across its direction, in that direction; where the state stands on
/// a contact and leaves it with a velocity, an event of this contact may lead there too.
double return_time(const LagrangianSystem& system, const State& guess, const OrbitQuestion& question);

}  // namespace mechanics::inline motions
