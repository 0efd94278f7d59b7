#pragma once

#include "cli/options.hpp"
#include "cli/report/motion_report.hpp"

namespace cli::inline reports {

/// Solved, or no solution where no law has a v+; inaccurate where there is no impact before the end.
Exit impact_laws_exit(const FollowedMotion&);
/// v+, P and T+ of every law of impact at the first impact of a motion.
std::string impact_laws_json(const FollowedMotion&);
std::string impact_laws_text(const FollowedMotion&);

}  // namespace cli::inline reports
