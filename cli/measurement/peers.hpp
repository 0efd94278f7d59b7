#pragma once

#include "cli/measurement/exams.hpp"

namespace cli::inline measurement {

/// Empty, or why there are no solvers of other packages.
std::string why_no_peers();

/// "peer not found: daqp, piqp; …": the packages that were not there when this was built; "" when all were.
std::string peers_not_found();

/// Tells on standard error which packages are not there. Throws InvalidInput when none is.
void require_peers();

/// The names of their methods, found or not.
std::vector<std::string> peer_names();

/// The solvers of other packages that were found at build time. DAQP, OSQP, PIQP and qpOASES take the
/// quadratic program: `daqp` with the package's own settings, `daqp-tight` with the tolerance that is asked
/// for, and so on. Those of Siconos (Debian: libsiconos-numerics-dev) take the explicit complementarity
/// problem M lambda
/// + U A⁻¹z - s, M = U A⁻¹Uᵀ: `siconos-lemke`, `siconos-pgs`, `siconos-newton-fb`. They give no bound: what
/// they say is that a tolerance is met, their own or the one asked for, and by that they are judged. A run
/// that ends without their "solved" has given up.
std::vector<Contest> peer_contests(const Exam&);

/// Every method before an exam, with `peers` those of other packages too.
std::vector<Contest> everybody(const Exam&, bool peers);

}  // namespace cli::inline measurement
