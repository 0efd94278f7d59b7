#pragma once

#include <string>
#include <vector>

#include "cli/problem_file/problem.hpp"

namespace cli::inline problem_files {

/// A number for each constraint, `otherwise` where no entry names it: of the entries that do the most special
/// counts, a member "gap[3]" before a part "gap[i in 2..5]" before its family "gap" or "gap[i]", and of two
/// as special the later. `where` is the key for messages. Throws InvalidInput for a name that no constraint
/// has, and for a range whose ends are no integers.
convex::Vector numbers_by_constraint(const std::string& where, double otherwise,
                                     const std::vector<NamedNumber>& entries,
                                     const std::vector<std::string>& constraints);

}  // namespace cli::inline problem_files
