#pragma once

#include "cli/report/answer.hpp"
#include "cli/report/motion_report.hpp"

namespace cli::inline reports {

/// v+, P and T+ of every law of impact at the first impact of a motion. No solution where no law has a v+;
/// inaccurate where there is no impact before the end.
Answer impact_laws_answer(const FollowedMotion&, bool json);

}  // namespace cli::inline reports
