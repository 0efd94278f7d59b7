#pragma once

#include <string>
#include <vector>

#include "cli/problem_file/problem.hpp"

namespace cli {

/// The tolerance of each constraint by `[solve] contact_tolerance`: of the entries that name it the most
/// special counts, a member "gap[3]" before a part "gap[i in 2..5]" before its family "gap" or "gap[i]", and
/// of two as special the later. Throws InvalidInput for a name that no constraint has, and for a range whose
/// ends are no integers.
convex::Vector contact_tolerances(const SolveSettings&, const std::vector<std::string>& constraints);

}  // namespace cli
