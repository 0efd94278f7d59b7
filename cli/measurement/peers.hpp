#pragma once

#include "cli/measurement/exams.hpp"

namespace cli {

/// Empty, or why there are no solvers of other packages.
std::string why_no_peers();

/// The solvers of Siconos (Debian: libsiconos-numerics-dev), where it was found at build time, on the
/// explicit complementarity problem M lambda + U A⁻¹z - s, M = U A⁻¹Uᵀ: `siconos-lemke`, `siconos-pgs`,
/// `siconos-newton-fb`. They give no bound: what they say is that the tolerance they were asked for is met,
/// and by that they are judged. A run that ends without their "solved" has given up.
std::vector<Contest> peer_contests(const Exam&);

}  // namespace cli
