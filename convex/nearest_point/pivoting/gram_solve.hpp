#pragma once

#include <optional>

#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/pivoting/corrections.hpp"
#include "convex/nearest_point/pivoting/gram_pivoting.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline pivoting {

/// The active-set method on the Gram matrix of whitened rows, for dense A and U: `GramPivoting` finds the
/// rows held in doubles; their point is corrected with residuals in twice the working precision; rows that
/// are wrong then by rounding change sides at that scale (`GramPivoting::settle_rest`); rows that the point
/// only touches are decided without rounding. An answer where nothing is left in doubt.
class GramSolve {
 public:
  /// The problem is referred to; its z and s may change from one solve to the next.
  GramSolve(const NearestPointProblem& problem, Arena& arena);

  /// False when something is in doubt; the solution is then not to be used.
  bool solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution);
  const GramPivoting& set() const { return *set_; }
  double scale() const { return known_.scale; }  ///< max(||q||_A, ||z||_(A⁻¹))
  /// The same after a `solve` that was true, from the rows that it ended with.
  bool solve_again(const Accuracy& accuracy, Solution& solution);

 private:
  template <class Engine>
  friend bool finish(Engine&, const Accuracy&, Solution&);

  void whiten_z();
  bool finish_settled(bool has_changed, const Accuracy& accuracy, Solution& solution);
  Corrections& corrections() { return known_; }
  bool is_exact_vertex() const;
  void take_point(bool has_changed);
  void list_rows_held(bool have_changed);
  double near_scale(double part);
  bool correct(bool is_first, double small);
  bool take_noise_for_zero(bool more);
  void residual(bool is_first);
  void rest_loads(bool is_first, bool with_outside);
  bool answer_of_doubles(const Accuracy& accuracy, Solution& solution);
  bool touches_rows() const;
  bool write(const Accuracy& accuracy, Solution& solution);
  void write_point(Solution& solution) const;
  Slacks measure_slacks();
  Slacks look_at_violated(Index count);
  void set_slacks_of_doubles();
  Slacks decide_degenerate_rows();
  Index measure_touched_slacks();
  double slack_noise(Index a) const;
  std::optional<double> slack_by_parallel_row(Index a) const;
  bool are_independent(const Index* rows, Index count, double part);
  void find_dual_rows();
  Index leave_sums_of_rows_held(Index count);
  bool find_way_up(Index count);
  double violation_of_touched_rows(double known) const;
  Residuals residuals_of_active();

  const NearestPointProblem& problem_;
  const DenseKernels& kernels_;
  const DenseFactor A_;
  const Index n_, m_, ld_;
  std::optional<GramPivoting> set_;
  double *z_, *w_free_, *w_, *q_, *q_low_, *r_, *dw_, *dq_, *inverse_diagonal_, *unit_, *row_scale_, *slack_;
  double *load_, *lambda_, *lambda_low_, *change_, *length_, *pull_;  // of the rows held, rows_
  // At places; total_ + total_low_: all multipliers, y_: their last change.
  double *y_, *total_, *total_low_, *rest_, *held_slack_;
  double *touched_slack_, *pack_, *dual_, *products_;  // touched_slack_: at q rounded
  Index *rows_, *touched_, *close_, *fresh_;
  std::optional<SlackOnEdge> edge_;
  Corrections known_;
  double z_norm_ = 0, acceleration_norm_ = 0, inverse_norm_ = 0, gram_condition_ = 0, magnitude_ = 0;
  double moved_ = 0;  ///< how far rows that the point touches may move the answer
  Index touched_count_ = 0;
};

}  // namespace convex::inline pivoting
