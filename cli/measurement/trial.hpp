#pragma once

#include <string>

#include "cli/measurement/contest.hpp"

namespace cli::inline measurement {

/// One contest at one setting of its method's accuracy.
struct Trial {
  std::string problem;
  convex::Index n = 0, m = 0;
  std::string method;
  convex::MethodKind kind = convex::MethodKind::direct;
  double setting = 0;  ///< the tolerance asked for
  double seconds = unknown, lower = unknown, upper = unknown;
  int repetitions = 0;
  Judgement judgement;

  Verdict verdict() const { return judgement.verdict; }
  bool is_right() const { return judgement.verdict == Verdict::ok; }
};

/// What a trial may cost.
struct TrialLimits {
  double budget = 0.05;  ///< seconds of repeated measurement
  double limit = 5;      ///< seconds before a single solve is too slow
};

/// Runs a contest in a process of its own.
Trial trial(const Contest&, const convex::Accuracy&, const TrialLimits&);

}  // namespace cli::inline measurement
