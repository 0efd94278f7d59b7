#pragma once

#include <optional>

#include "convex/exact/grid_sum.hpp"
#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/pivoting/corrections.hpp"
#include "convex/nearest_point/pivoting/gram_solution.hpp"
#include "convex/nearest_point/pivoting/gram_working_set.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline pivoting {

/// The active-set method on the Gram matrix of whitened rows, for dense A and U: a working set finds the rows
/// held in doubles; their point is corrected with residuals in twice the working precision; rows that are
/// wrong then by rounding change sides at that scale; rows that the point only touches are decided without
/// rounding. An answer where nothing is left in doubt.
class GramSolve {
 public:
  /// The working set is referred to; z and s of its problem may change from one solve to the next.
  explicit GramSolve(GramWorkingSet& set);

  /// False when something is in doubt; the solution is then not to be used.
  bool solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution) {
    return set_.settle(guess) && answer(accuracy, solution);
  }
  /// The same after a `solve` that was true, from the rows that it ended with.
  bool solve_again(const Accuracy& accuracy, Solution& solution);

 private:
  /// What slacks at a corrected point say of it; violated: beyond rounding, by `Corrections::wrong`.
  enum class Slacks { kept, violated, doubtful };

  bool answer(const Accuracy& accuracy, Solution& solution);
  bool correct_until_told(const Accuracy& accuracy, Solution& solution);
  bool doubles_do(double close);
  bool is_clear(double size);
  double near_scale(double part);
  bool write(const Accuracy& accuracy, Solution& solution);

  Slacks measure_slacks();
  Slacks look_at_violated(Index first, Index end);
  Slacks decide_degenerate_rows(Index count);
  std::span<const Index> close(Index first, Index end) const { return {p_.close + first, p_.close + end}; }
  bool keeps_close(Index count);
  bool is_at_rest() const;
  bool touches_rows() const;
  Index close_rows(double absolute, double by_length, Index most) {
    return pivoting::close_rows(p_, problem_, absolute, by_length, most);
  }
  void find_violation_of_degenerate_rows(Index count);
  Index measure_precisely(Index count);
  double slack_noise(Index a) const;
  Index leave_sums_of_working_set(Index count);
  std::optional<double> slack_by_parallel_row(Index a) const;
  bool find_way_up(Index count);

  GramWorkingSet& set_;
  const NearestPointProblem& problem_;
  GramPoint& p_;
  Corrections known_;
  std::optional<SlackOnEdge> edge_;
  GridTest rows_;                    ///< all entries of U
  double moved_ = 0;                 ///< how far rows that the point touches may move the answer
  double degenerate_violation_ = 0;  ///< by these rows, at q rounded, as in `residuals`
};

}  // namespace convex::inline pivoting
