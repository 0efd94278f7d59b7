#pragma once

#include <string>

#include "mechanics/motion/orbit.hpp"

namespace cli::inline commands {

/// What a branch passes between two orbits: "fold", "flip" or "torus" where multipliers cross the unit circle
/// at 1, at -1 or as a pair, "grazing" where the number of impacts changes, "" where nothing happens.
/// Of an orbit of free period the multiplier 1 along it crosses nothing.
std::string event_between(const mechanics::Orbit& before, const mechanics::Orbit& now, bool is_free);

}  // namespace cli::inline commands
