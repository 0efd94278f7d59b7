#pragma once

#include <vector>

#include "cli/drawing/work_precision_drawing.hpp"
#include "cli/measurement/trial_files.hpp"

namespace cli::inline drawings {

/// The failure map: a panel for each family, a row for each method, a column for each difficulty; digits of
/// accuracy as colour and number, marks for what was wrong, gave up, was too slow, crashed or does not apply.
Drawing failure_map_drawing(const std::vector<StressTrial>&);

}  // namespace cli::inline drawings
