#pragma once

#include <memory>
#include <optional>
#include <span>

#include "convex/nearest_point/optimality/exact_slack.hpp"
#include "convex/nearest_point/pivoting/affine_piece.hpp"
#include "convex/nearest_point/pivoting/corrections.hpp"
#include "convex/nearest_point/pivoting/small_tableau.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline pivoting {

/// `GramSolve` where coordinates are few: the Gram matrix of the whitened rows looked at is swept at the rows
/// held, so that one pivot gives all multipliers and slacks (principal pivoting: Keller 1973; the sweep:
/// Beaton 1964), by the steps of the dual method (Goldfarb and Idnani 1983). Few rows are looked at all at
/// once; of many those that are violated, eight at a time: what has been looked at is settled before all are
/// measured again, so that the dual objective grows each time and this ends. Where corrections leave a doubt,
/// the rows held are handed on.
class SmallGramSolve {
 public:
  static bool fits(const NearestPointProblem& problem) {
    return problem.dimension() <= SmallTableau::most_coordinates;
  }

  /// The problem is referred to; its z and s may change from one solve to the next.
  SmallGramSolve(const NearestPointProblem& problem, SmallTableau& tableau);

  /// Puts z, s and the rows to begin with into the tableau; the first half of `solve`.
  void begin(const std::vector<Index>& guess);
  /// False when something is in doubt; the solution is then not to be used.
  bool solve(const std::vector<Index>& guess, const Accuracy& accuracy, Solution& solution);
  /// The same after a `solve` that was true, from the rows that it ended with.
  bool solve_again(const Accuracy& accuracy, Solution& solution);
  /// The same where the affine piece of these rows is known and nothing comes near its edge: all numbers are
  /// finite then.
  bool solve_on_affine_piece(const Accuracy& accuracy, Solution& solution);
  std::vector<Index> one_sided_rows_held() const;
  /// Weights of rows that contradict each other, as doubles tell, where pivoting met such; they are to be
  /// proved.
  std::optional<Vector> contradiction() const;
  double scale() const { return tableau_.z_norm; }
  Index steps() const { return tableau_.steps; }

 private:
  /// So few rows touched are looked at at once.
  static constexpr Index few_touched = 16;

  template <class Engine>
  friend bool finish(Engine&, const Accuracy&, Solution&);

  void take_linear_term();
  void follow_working_set();
  bool find_affine_piece();
  bool look_at(const Index* rows, Index count);
  bool settle();
  Index fresh_violated_rows(Index* rows);
  bool looks_at_all() const { return slack_ == tableau_.slack; }
  Index place(Index a) const { return looks_at_all() ? a : place_[a]; }
  void measure();
  void measure_slacks_of_all();
  bool answer(const Accuracy& accuracy, Solution& solution);
  Corrections& corrections() { return known_; }
  /// This part of the scale where multipliers (times lengths) or slacks (over them) are smaller at the point
  /// settled on: the first correction tells their signs already. 0 where there are none, or where one of
  /// these rows, which are looked at for it, depends on those held.
  double near_scale(double part);
  bool correct(bool is_first, double small);
  void mark_weak(double small);
  bool take_noise_for_zero(bool more);
  bool is_at_rest() const;
  Slacks measure_slacks();
  Slacks look_at_violated(std::span<const Index> rows);
  bool look_at_fresh(std::span<const Index> rows, Index most);
  Slacks decide_degenerate_rows();
  bool holds(Index a) const { return place(a) >= 0 && tableau_.held[place(a)]; }
  bool leave_sums_of_rows_held();
  bool keeps_touched_rows() const;
  std::span<const Index> touched() const { return {close_, close_ + touched_count_}; }
  bool is_clear(double size);
  Index close_rows(double absolute, double by_length);
  bool doubles_do(double close);
  bool write(const Accuracy& accuracy, Solution& solution);
  Residuals residuals() const;

  const NearestPointProblem& problem_;
  SmallTableau& tableau_;
  double *row_scale_, *slack_;  ///< of all rows; ||u_a||_(D⁻¹), where rows are many no less and hardly more
  double* touched_slack_;       ///< of the rows touched, where they are known without rounding
  double* inverse_scale_ = nullptr;
  Index *close_, *place_ = nullptr;  ///< place_: of a row, -1 for one not looked at; where rows are many
  Index touched_count_ = 0;          ///< so many of close_ are rows touched
  Index sweeps_ = 0;
  std::unique_ptr<AffinePiece> piece_;
  Index kept_ = 0;  ///< solves in a row that have ended with the working set of the one before
  Corrections known_;
  std::optional<SlackOnEdge> edge_;
  double zeroed_ = 0;  ///< the multipliers of weak rows, times their lengths
  double touched_violation_ = 0;
};

}  // namespace convex::inline pivoting
