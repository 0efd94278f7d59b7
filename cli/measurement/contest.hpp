#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "convex/nearest_point/methods.hpp"

namespace cli::inline measurement {

/// How a trial ended. wrong: the true error is more than ten times the bound that came with the answer, or a
/// problem was called solvable that is not (or not solvable that is). gave_up: it said so. refused: it does
/// not apply.
enum class Verdict { ok, wrong, gave_up, too_slow, refused, crashed };

/// "ok", "wrong", "gave-up", "too-slow", "refused", "crashed".
std::string verdict_text(Verdict);

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// What a piece of work left behind, compared with the truth.
struct Judgement {
  Verdict verdict = Verdict::ok;
  double error = unknown;             ///< relative; of what, each kind of contest says
  double multiplier_error = unknown;  ///< max_a |lambda_a - lambda*_a| over max_a |lambda*_a|
  double bound = unknown;             ///< the method's own, on the scale of `error`
  bool polished = false;              ///< the method found the rows, the judge gave the digits
};

/// A true error above ten times the bound (or above ten roundings, where a bound says less) is wrong.
bool exceeds(double error, double bound);

/// One method before one problem, whatever the kind of either: work to be timed, and its judgement. Another
/// kind of cost and error is another maker of contests.
struct Contest {
  std::string problem;
  convex::Index n = 0, m = 0;
  std::string method;
  convex::MethodKind kind = convex::MethodKind::direct;
  std::string refused;  ///< why the method does not apply; empty when it does
  /// From raw numbers to the answer, factorisations included.
  std::function<void(const convex::Accuracy&)> work;
  std::function<Judgement()> judged;  ///< of the last work
};

}  // namespace cli::inline measurement
