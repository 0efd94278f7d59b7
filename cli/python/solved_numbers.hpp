#pragma once

#include <optional>

#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"

namespace python {

/// How numbers are to be solved: every call's last arguments.
struct SolveChoice {
  const convex::Method* method = nullptr;
  convex::Accuracy accuracy;
};

/// A problem given by numbers, with its answer; what is seldom asked for is computed when it is.
class SolvedNumbers {
 public:
  /// Throws InvalidInput as `validate`, and when the method does not apply.
  SolvedNumbers(convex::NearestPointProblem problem, const SolveChoice& choice);

  const convex::NearestPointProblem& problem() const { return problem_; }
  const convex::Solution& solution() const { return solution_; }
  double tolerance() const { return tolerance_; }
  bool has_answer() const { return solution_.q.size() == problem_.dimension(); }
  /// Of least norm where they are not unique, with their ranges.
  const convex::Multipliers& multipliers() const;
  /// R = Σ lambda_a u_a.
  const convex::Vector& reaction() const;

 private:
  convex::NearestPointProblem problem_;
  convex::Solution solution_;
  double tolerance_;
  mutable std::optional<convex::Multipliers> multipliers_;
  mutable std::optional<convex::Vector> reaction_;
};

}  // namespace python
