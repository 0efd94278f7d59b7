#pragma once

#include <span>

#include "convex/dense/arena.hpp"
#include "convex/dense/dense_kernels.hpp"
#include "convex/double_double.hpp"
#include "convex/nearest_point/pivoting/gram_point.hpp"

namespace convex::inline pivoting {

/// What `SweptRows` and its kernels work on: the rows looked at of a dense problem of few coordinates, in
/// arrays that stay in the first caches. Each has a place; blocks are of eight rows side by side
/// (`DenseKernels`). Places without a row hold zeros.
struct SmallTableau : GramPoint {
  static constexpr Index most_coordinates = 32, most = 64;  // of places
  /// Up to so many rows all are looked at from the start, row a at place a.
  static constexpr Index few_rows = 32;

  SmallTableau();
  SmallTableau(const SmallTableau&) = delete;

  Index m = 0, stride = 0;  // m: places; stride: m in whole packs

  alignas(64) double raw[most_coordinates * most];       ///< u_a
  alignas(64) double whitened[most_coordinates * most];  ///< v_a = L⁻¹u_a
  /// The Gram matrix G of the v_a, swept at the working set S, is -G_SS⁻¹ there, G_oS G_SS⁻¹ beside it, and
  /// the Schur complement of G_SS elsewhere (Beaton 1964). Of that the diagonal is kept, and the column of
  /// each pivot as it was before, from which any other is found (the product form: Dantzig and Orchard-Hays
  /// 1954).
  alignas(64) double swept_diagonal[most], pivot_columns[most * most];
  Index pivots = 0, pivot_place[most], last_pivot[most];  ///< last_pivot: at a place, -1 for none
  double over_pivot[most], pivot_sign[most];  ///< sign: 1 for a row that came in, -1 for one that left
  /// lambda_a of a row of the working set, s_a - u_a·q of another.
  alignas(64) double b[most];
  alignas(64) double load[most];                           ///< s_a - v_a·w_free
  alignas(64) double level[most], square[most];            ///< s_a, |v_a|²
  alignas(64) double scale_at[most], inverse_scale[most];  ///< `row_scale`, and 1 over it
  /// Per row, by its state: `leave` is minus the scale of a row that may leave, `enter` the inverse of that
  /// of one that may enter, 0 otherwise; share: 1 for a row of the working set.
  alignas(64) double leave[most], enter[most], share[most];
  alignas(64) double slack_at[most];  ///< where all rows are looked at, `slack` too
  alignas(64) double rest[most];  ///< s_a - u_a·q - v_a·dw, dw what the equations of motion miss, whitened
  bool is_weak[most];             ///< may change sides in a correction
  Index row[most];                ///< at a place; -1 for none
  Arena all_rows;                 ///< arrays for all rows, where these are many
  const double *linear = nullptr, *s = nullptr;  ///< z and s of the problem, not padded
  bool held[most], two_sided[most];
  bool is_listed = false;  ///< no row has come or gone since those held were listed

  Index dependent = -1;  ///< the violated row that is nearly dependent on those held, if pivoting met one
  bool is_first = true;  ///< the next correction is; q_low is 0 then
  bool any_weak = false;
  double sweep_growth =
      1;  ///< by what sweeps may have enlarged rounding: the largest of |v_k|² over its pivot

  struct Room {
    alignas(64) double coordinates[10][most_coordinates];
    alignas(64) double held[6][most], at_places[2][most];
    alignas(64) double pack[8 * most_coordinates], coefficients[8 * most_coordinates],
        degenerate_slack[few_rows];
    Index rows[most], place[most], close[few_rows];
  } room;  ///< what `GramPoint` points to
};

struct CriticalRegion;

/// What `SweptRows` does with it, for one processor family. Each is false when something is in doubt.
struct SmallKernels {
  /// `diagonal`, that of A, and what is made of it.
  void (*take_diagonal)(SmallTableau&, const double* diagonal);
  /// Whitens, and takes in the rows marked in `held` and `two_sided`.
  bool (*begin)(SmallTableau&);
  /// Looks at eight more rows, at the places from `stride` on, which are to have their `row`.
  void (*append)(SmallTableau&);
  /// Whitens z anew and goes on with the rows that are held.
  bool (*begin_again)(SmallTableau&);
  /// Pivots until no row is violated and no multiplier negative; then q, w, lambda.
  bool (*settle)(SmallTableau&);
  /// The least multiplier (times the row's length) of a row that may leave and slack (over it) of one that
  /// may come in, at the point settled on.
  double (*margin)(SmallTableau&);
  /// One correction of q + q_low with residuals in twice the working precision, in which weak rows may change
  /// sides: by dq, `change` of lambda; `step`.
  bool (*correct)(SmallTableau&);
  /// The point of a critical region for z and s: q + q_low, lambda, the norms of q and z, `magnitude`,
  /// `stationarity`, where rows are few `slack`; and what the region tells.
  void (*take_affine_point)(CriticalRegion&, const double* z, const double* s);
  /// `slack` where all rows have been looked at, and `magnitude`, in doubles.
  void (*measure)(SmallTableau&);
  /// What is missing of the equations of motion, in doubles.
  void (*measure_balance)(SmallTableau&);
  /// The column at a place of the Gram matrix as it is swept.
  void (*find_column)(const SmallTableau&, Index place, double* column);
  /// A vector for each row of the working set, by eights side by side: their products with a row of U are its
  /// coefficients over these.
  void (*dual_rows)(const SmallTableau&, double* dual);
  /// Lists the rows of m whose slack is not above `absolute` |s| + `by_length` times the length; s may be
  /// read up to `end`. Their number; where it is more than `most`, it may not be that of all.
  Index (*close_rows)(Index m, const double* slack, const double* s, const double* end, const double* length,
                      double absolute, double by_length, Index most, Index* rows);
  /// About the root of Σ_i u_ai² weight_i, times `longer`, for each of the m rows of U, and about 1 over the
  /// root, within a hundredth of it; 0 for 0. The sum of the squares of these lengths.
  double (*rough_lengths)(Index m, Index n, const double* U, const double* weight, double longer,
                          double* length, double* inverse);
  /// slack_a := u_a·q - s_a. Of the rows a = k mod 8 the one that lies deepest below its edge, by slack over
  /// length, and how deep, negative for violated ones: 8 each, for k = 0, ..., 7.
  void (*deepest)(Index m, Index n, const double* U, const double* q, const double* s,
                  const double* inverse_length, double* slack, double* depth, double* row);
};

const SmallKernels& small_kernels();

/// All that this processor can run.
std::span<const SmallKernels* const> all_small_kernels();

}  // namespace convex::inline pivoting
