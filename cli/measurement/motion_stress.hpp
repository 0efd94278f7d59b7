#pragma once

#include "cli/measurement/stress_families.hpp"

namespace cli::inline measurement {

/// Motions that are harder and harder to follow, each with a closed form: mass ratio in impacts, grazing,
/// nearly simultaneous impacts, long accumulations, stiff springs, drift over many impacts.
std::vector<StressFamily> motion_families();

}  // namespace cli::inline measurement
