#pragma once

#include "cli/report/motion_report.hpp"

namespace cli::inline reports {

/// v+, P and T+ of every law of impact at the first impact of a motion.
std::string impact_laws_json(const FollowedMotion&);
std::string impact_laws_text(const FollowedMotion&);

}  // namespace cli::inline reports
