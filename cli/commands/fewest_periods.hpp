#pragma once

#include "mechanics/lagrangian_system.hpp"
#include "mechanics/motion/orbit.hpp"

namespace cli::inline commands {

/// After how many of the periods asked for an orbit comes back already: a divisor of `periods`.
long fewest_periods(const mechanics::LagrangianSystem&, const mechanics::Orbit&,
                    const mechanics::OrbitQuestion&, long periods);

}  // namespace cli::inline commands
