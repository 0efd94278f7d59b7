#pragma once

#include <optional>
#include <vector>

#include "convex/nearest_point/pivoting/gram_factor.hpp"

namespace convex::inline pivoting {

/// Principal pivoting by blocks (Júdice and Pires 1994; Kunisch and Rendl 2003) on the Gram matrix of
/// whitened rows: the deepest of the violated rows come in and rows with a multiplier that is not positive go
/// out, all at once, until none is wrong; single steps of the dual method (Goldfarb and Idnani 1983) where
/// blocks do not lead there. With few rows the Gram matrix has all of them; with many, those that came in.
class GramPivoting {
 public:
  /// A row of the working set of which less than this part, squared, lies outside the span of the others:
  /// nearly dependent, left to an orthogonal factor; or dependent as far as doubles tell, and left out of the
  /// working set.
  static constexpr double near_dependence = 1e-11, dependence = 1e-13;
  /// A smaller violation than this part of the scale does not count in doubles.
  static constexpr double least_violation = 1e-12;

  /// w_free = L⁻¹z, padded; row_scale: ||u_a||_(D⁻¹), D the diagonal of A, by which violations are compared.
  GramPivoting(const NearestPointProblem& problem, Arena& arena, const double* w_free,
               const double* row_scale);
  /// Cache lines that it takes from the arena.
  static Index lines(Index n, Index m);

  /// False when it does not settle, or when rows of the working set are nearly dependent. guess: rows to
  /// begin with.
  bool settle(const std::vector<Index>& guess);
  /// The same from the working set now, after z and s of the problem have changed, and w_free with them.
  bool settle_again();
  /// The point of the working set now, whatever its signs.
  bool keep_working_set();

  /// Pivots at the scale of what a point misses of its equations, on the same Gram matrix. Rows of the
  /// working set whose multiplier is clear of 0 stay, rows outside that are clear of their edge stay out; the
  /// others change sides as the loads tell, at places: s_a - u_a·q - v_a·g for a point q whose equations of
  /// motion, whitened, miss g, the weak multipliers counted as 0. `lambda` has the multipliers to add then.
  /// `clear_rows` comes first: which rows these are, by multipliers at places times lengths, and by slacks
  /// over `row_scale`, that exceed `zero`.
  void clear_rows(double zero, const double* multipliers, const double* slacks);
  bool settle_rest(const double* load, double norm);
  /// After `clear_rows`: held, but not clear of 0.
  bool is_weak(Index a) const { return state_[a] == held; }
  /// After `clear_rows`: held or close to its edge.
  bool matters(Index a) const { return state_[a] != clear_outside; }
  const double* slacks() const { return slack_; }  ///< m: at the point that `settle` ended with

  /// Weights of rows that contradict each other, as doubles tell; none where pivoting met none.
  const std::optional<Vector>& contradiction() const { return contradiction_; }
  std::vector<Index> one_sided_working_set() const;

  const GramRows& rows() const { return rows_; }
  Index size() const { return set_.size(); }            ///< rows of the working set
  Index place(Index j) const { return set_.place(j); }  ///< of the j-th
  Index row(Index j) const { return set_.row(j); }
  bool holds(Index a) const { return state_[a] >= held; }
  bool is_two_sided(Index a) const { return state_[a] == two_sided; }
  Index steps() const { return steps_; }            ///< rows taken in or dropped
  const double* lambda() const { return lambda_; }  ///< multipliers at their places

  /// Takes rows into `rows`, without holding them. False when there is no room.
  bool look_at(const Index* rows, Index count) { return rows_.add(rows, count); }

  /// Holds more rows that have been looked at behind those held, as far as they are independent; they do not
  /// count as held by `holds`. False when there is doubt. `hold_no_more` lets go of them.
  bool hold_also(const Index* rows, Index count);
  void hold_no_more();
  Index firm() const { return firm_; }  ///< so many of its rows come before those

  /// x := (VᵀV)⁻¹x over the working set; padded.
  void solve(double* x) const { set_.solve(x); }
  void solve_pack(double* X) const { set_.solve_pack(X); }
  /// Squared distances of up to eight rows looked at to the span of those held; X: room for as many packs.
  void distances(const Index* rows, Index count, double* X, double* squared) const;
  /// w = w_free + V lambda and q = L⁻ᵀw of the rows that it settled on, padded.
  void point(double* w, double* q) const;
  /// No less than the largest 1/R_jj, V = Q R over the working set, whose entries are not small.
  double inverse_norm() const;
  /// An estimate of the condition of the Gram matrix of the working set, each divided by its length, by
  /// inverse iteration; x: room for the working set, padded.
  double condition(double* x) const;

 private:
  /// clear_outside, clear: of rows that `clear_rows` has found to be so.
  enum State : Index { outside, passed, clear_outside, held, clear, two_sided };

  bool all_known() const;
  bool start(const std::vector<Index>& guess);
  void start_pivoting();
  bool pivot();
  bool pivot_by_blocks();
  Index block_of(Index violated) const;
  double counted_violation() const;
  Index list_violated(State state);
  bool has_negative() const;
  Index drop_negative();
  /// Whether row a lies deeper below its edge, or closer to it, than row b.
  bool is_deeper(Index a, Index b) const { return slack_[a] * row_scale_[b] < slack_[b] * row_scale_[a]; }
  Index choose_deepest(Index count, Index room);
  Index skip_parallel_rows(Index count);
  bool take_in(Index count);
  Index fill_block(Index fresh);
  void change(Index count);
  bool pivot_by_single_steps();
  Index fill_up(Index count);
  bool descend_known();
  bool drop_most_negative();
  bool raise_in_turn(Index count);
  double slack_at_place(Index place) const;
  bool raise(Index a);
  void find_point(double* w, double* q) const;
  void collect();
  bool factor();
  bool find_multipliers();
  void find_energy();
  void find_slacks();
  void find_known_slacks(double* at_places) const;

  const NearestPointProblem& problem_;
  const DenseKernels& kernels_;
  const DenseFactor A_;
  const Index n_, m_, capacity_;
  GramRows rows_;
  const double *w_free_, *row_scale_;
  GramFactor set_;  // of the working set
  double *lambda_, *w_, *q_, *slack_, *known_slack_, *load_, *column_;
  Index *state_, *list_, *entering_;
  Index steps_ = 0;
  Index firm_ = -1;  // where others are held too: the first firm_ rows are held, whatever these are
  double energy_ = 0, z_norm_ = 0;
  bool by_single_steps_ = false, any_close_ = false;
  const double* target_;  // the loads that are solved for, at places
  std::optional<Vector> contradiction_;
};

}  // namespace convex::inline pivoting
