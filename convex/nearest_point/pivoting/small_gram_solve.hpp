#pragma once

#include <memory>

#include "convex/nearest_point/pivoting/small_tableau.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex {

/// `GramSolve` where coordinates and rows are few: the Gram matrix of all whitened rows is swept at the rows
/// held, so that one pivot gives all multipliers and slacks (principal pivoting: Keller 1973; the sweep:
/// Beaton 1964). The row that is violated most comes in, the multiplier that is most negative goes out; then
/// one correction. Where that leaves a doubt, the rows held are handed on.
class SmallGramSolve {
 public:
  static bool fits(const NearestPointProblem&);

  /// The problem is referred to; its z and s may change from one solve to the next.
  SmallGramSolve(const NearestPointProblem& problem, SmallTableau& scene);

  /// Puts z, s and the rows to begin with into the scene; the first half of `solve`.
  void begin(const std::vector<Index>& guess);
  /// False when something is in doubt; the solution is then not to be used.
  bool solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution);
  /// The same after a `solve` that was true, from the rows that it ended with.
  bool solve_again(const Accuracy& accuracy, Solution& solution);
  std::vector<Index> one_sided_rows_held() const;

 private:
  void take_force();
  bool answer(const Accuracy& accuracy, Solution& solution);
  bool correct();
  bool round();
  bool is_clear(double size);
  bool keeps_rows_outside();
  bool doubles_do(double close);
  Residuals residuals() const;

  const NearestPointProblem& problem_;
  SmallTableau& scene_;
  Index sweeps_ = 0;
  double scale_ = 0, condition_ = 0, contraction_ = 0, magnitude_ = 0, remaining_ = 0, silenced_ = 0,
         rounding_ = 0, bound_ = 0;
};

}  // namespace convex
