#pragma once

#include <string>
#include <vector>

#include "convex/double_double.hpp"
#include "convex/nearest_point/methods.hpp"

namespace cli {

/// A problem with its truth, to be put before methods.
struct Exam {
  std::string name;
  convex::NearestPointProblem problem;
  bool feasible = true;
  convex::DoubleDoubleVector solution;  ///< n, when feasible
  convex::Vector multipliers;           ///< m, where they are known and unique; else empty
};

/// How a trial ended. wrong: the true error is more than ten times the bound that the method gave with its
/// answer, or a problem was called solvable that is not (or not solvable that is). gave_up: it said so.
/// refused: it does not apply.
enum class Verdict { ok, wrong, gave_up, too_slow, refused, crashed };

/// "ok", "wrong", "gave-up", "too-slow", "refused", "crashed".
std::string verdict_text(Verdict);

/// One method on one problem at one setting of its accuracy.
struct Trial {
  std::string problem;
  convex::Index n = 0, m = 0;
  std::string method;
  convex::MethodKind kind = convex::MethodKind::direct;
  double setting = 0;     ///< the tolerance asked for
  bool polished = false;  ///< the answer may be the point of the rows that an iteration showed to be active
  double seconds = 0, lower = 0, upper = 0;
  int repetitions = 0;
  double error = 0;             ///< ||q - q*||_A over max(||q*||_A, ||z||_(A⁻¹))
  double multiplier_error = 0;  ///< max_a |lambda_a - lambda*_a| over max_a |lambda*_a|; NaN where not known
  double bound = 0;             ///< the method's own, on the scale of `error`
  Verdict verdict = Verdict::ok;
};

/// What a trial may cost.
struct TrialLimits {
  double budget = 0.05;  ///< seconds of repeated measurement
  double limit = 5;      ///< seconds before a single solve is too slow
};

/// Runs a method on an exam in a process of its own. The time is that from raw numbers to the answer: the
/// factorisation of A is part of it.
Trial trial(const Exam&, const convex::Method&, const convex::Accuracy&, const TrialLimits&);

}  // namespace cli
