#pragma once

#include "convex/nearest_point/sparse/mehrotra_step.hpp"
#include "convex/nearest_point/sparse/row_system.hpp"

namespace convex::inline sparse {

/// Mehrotra's predictor-corrector method (1992) on a scaled sparse problem, regularised as in Friedlander and
/// Orban (2012), to see which rows are active; not to be exact. Two-sided rows are held by a weight
/// 1/regularisation. Redundant rows and rows without a strictly feasible point only cost some steps.
class InteriorPointStart {
 public:
  /// free: A⁻¹z, scaled; the violations of the rows there tell how large slacks may be.
  InteriorPointStart(const BalancedProblem&, RowSystem&, const Vector& free);

  enum class End { steady, close, stalled, unbounded };
  /// Steps until the mean of lambda ∘ slack is at most `gap`. steady, where that is asked for: no row changed
  /// sides in the last step, and the equations are met ten times better than at the start. unbounded:
  /// multipliers grow beyond all bounds, as where rows contradict each other.
  End approach(double gap, bool until_steady = false);
  /// Begins from a point with multipliers that solve a problem like this one: the rows that look active there
  /// are held, and exchanged as long as fewer are wrong each time. Where none is wrong any more, that is the
  /// answer: how far from it corrections of the rows of the working set leave q, in the norm of A, at most
  /// about this part of it. Else +inf, and pairs of multiplier and slack begin with what was missing; or as
  /// ever, where that is as far away as any start.
  double start_near(const Vector& q, const Vector& lambda, double part);
  bool began_near() const { return began_near_; }

  const Vector& q() const { return at_.q; }
  const Vector& lambda() const { return at_.lambda; }
  /// Whether row a looks active: two-sided, or with a multiplier above its slack.
  bool looks_active(Index a) const {
    return problem_.two_sided[static_cast<std::size_t>(a)] || at_.lambda[a] > at_.slack[a];
  }
  Index steps() const { return steps_; }
  /// No active set follows: it begins well inside, and `approach` ends as stalled after so many steps in all;
  /// 0: no such limit.
  void stand_alone(Index limit);

 private:
  void start();
  double hold_active_rows();
  void centre(double product);
  void solve(const Vector& dual_rest, const Vector& primal_rest, const Vector& target,
             InteriorPointState& to) const;
  Index changes_of_sides();
  bool one_sided(Index a) const { return step_.one_sided(a); }

  const BalancedProblem& problem_;
  RowSystem& system_;
  MehrotraStep step_;
  InteriorPointState at_;
  Vector weight_;
  std::vector<bool> side_;  ///< of each row, as it looked before the last step
  double usual_slack_, first_rest_ = 0;
  Index steps_ = 0, limit_ = 0;
  bool stands_alone_ = false;
  bool started_ = false, held_ = false;  ///< held: factored with the weights of hold_active_rows
  bool corrected_same_ = false;          ///< its last correction was of the rows of the one before
  bool began_near_ = false;
};

}  // namespace convex::inline sparse
