#pragma once

#include <memory>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// Nearest-point problems with the same A and U, one after the other, as a control or a motion asks for them.
/// What does not change is kept: the factor of A, the whitened rows with their Gram matrix, and the rows that
/// were active, from which the next solve begins; of few coordinates the affine map from z and s to the answer
/// that holds while these stay. Answers are those of `active_set`, to the same accuracy and with the same
/// status; once that map is known nothing is allocated. Not to be shared by threads.
class RepeatedProblem {
 public:
  /// Throws InvalidInput as `validate` does.
  explicit RepeatedProblem(NearestPointProblem problem, const Accuracy& accuracy = {});
  ~RepeatedProblem();
  RepeatedProblem(RepeatedProblem&&) noexcept;
  RepeatedProblem& operator=(RepeatedProblem&&) noexcept;

  /// The problem with z (n) and s (m) in place of its own. The solution stands until the next call. Throws
  /// InvalidInput when sizes do not fit or an entry is not finite.
  const Solution& solve(const Vector& z, const Vector& s);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace convex
