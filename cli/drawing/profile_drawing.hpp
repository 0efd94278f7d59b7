#pragma once

#include <vector>

#include "cli/drawing/work_precision_drawing.hpp"

namespace cli::inline drawings {

/// Performance profiles (Dolan and Moré 2002): for each method the part of the problems that it solves, to
/// 1e-9 of the truth, within tau times the time of the quickest.
Drawing profile_drawing(const std::vector<Trial>&);

}  // namespace cli::inline drawings
