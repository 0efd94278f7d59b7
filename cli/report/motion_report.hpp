#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "mechanics/motion/rounding_growth.hpp"

namespace cli::inline reports {

/// A motion that has come to its end, and what is to be told of it.
struct FollowedMotion {
  std::string file, title;
  const mechanics::LagrangianSystem& system;
  const mechanics::Motion& motion;
  std::vector<mechanics::MotionEvent> first_events;  ///< some, for the reader
  double until = 0;
  bool interrupted = false;
  double seconds = 0;
  std::optional<mechanics::RoundingGrowth> growth;  ///< where it was looked for
  mechanics::State begin;                           ///< its start
  std::string choice;                               ///< of "auto", where it is the ordinary one
};

/// 0 done, 1 infeasible, 3 stopped.
Exit motion_exit(const FollowedMotion&);
/// docs/motion.md: one JSON object, or a text.
std::string motion_json(const FollowedMotion&);
std::string motion_text(const FollowedMotion&);

/// How many events a text lists.
inline constexpr std::size_t events_in_text = 24;

}  // namespace cli::inline reports
