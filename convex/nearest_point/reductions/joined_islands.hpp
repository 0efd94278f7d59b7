#pragma once

#include <vector>

#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline reductions {

/// Puts the answer of the whole together from those of its islands. Energies of islands add up, and so do the
/// squares of errors; residuals are computed for the whole.
class JoinedIslands {
 public:
  explicit JoinedIslands(const NearestPointProblem& whole);

  /// Takes over the answer of a part; coordinates and rows: the part's, as numbered in the whole.
  void add(Solution part, const std::vector<Index>& coordinates, const std::vector<Index>& rows);
  /// The same for a part without an answer: then the whole has none.
  void fail(Solution part, const std::vector<Index>& rows);
  bool failed() const { return failed_; }
  /// A row that took no part.
  void leave_out(Index row, LeftOutBecause why);
  Solution finish(const Accuracy&);

 private:
  const NearestPointProblem& whole_;
  Solution solution_;
  double error_ = 0, rounding_ = 0, acceleration_ = 0, linear_ = 0;  // squares of norms
  double most_flops_ = -1;
  std::vector<Index> unsolved_;  // rows whose slack is to be computed
  bool failed_ = false;
};

}  // namespace convex::inline reductions
