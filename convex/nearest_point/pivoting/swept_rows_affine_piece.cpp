#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/nearest_point/pivoting/corrections.hpp"
#include "convex/nearest_point/pivoting/swept_rows.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline pivoting {
namespace {

/// Corrections of a column of an affine piece, before it is given up.
constexpr int most_corrections = 6;

}  // namespace

/// After a solve with pivots and corrections. The piece of a working set costs about as much as a solve for
/// each of its columns: it is found when so many solves have kept the set, so that it at most doubles what
/// all have cost, whatever comes after.
void SweptRows::follow_working_set() {
  const SmallTableau& t = tableau_;
  sweeps_ += t.steps;
  if (t.steps > 0) kept_ = 0;
  if (++kept_ == t.n + t.size && !find_affine_piece()) piece_.reset();
}

/// False when a column cannot be told to twice the working precision.
bool SweptRows::find_affine_piece() {
  SmallTableau& t = tableau_;
  if (!piece_) piece_ = std::make_unique_for_overwrite<AffinePiece>();
  AffinePiece& piece = *piece_;
  const Index n = t.n;
  piece.columns = n + t.size;
  piece.stride = padded(piece.columns);
  for (double* x : {piece.error, piece.length, piece.pull, piece.x}) fill_packs(piece.stride, 0, x);
  std::copy_n(t.rows, t.size, piece.rows);
  double unit = 0;  // the largest ||·||_D of a coordinate
  for (Index i = 0; i < n; ++i) {
    piece.length[i] = std::sqrt(t.diagonal[i]);
    piece.pull[i] = -piece.length[i];
    unit = std::max(unit, piece.length[i]);
  }
  for (Index k = 0; k < t.size; ++k) {
    piece.length[n + k] = t.length[k];
    piece.pull[n + k] = t.pull[k] > 0 ? t.pull[k] : -t.length[k];
  }
  for (Index j = 0; j < piece.columns; ++j) {
    double* const column = piece.balance + j * t.ld;
    fill_packs(t.ld, 0, column);
    std::copy_n(j < n ? t.A + j * n : t.U + t.rows[j - n] * n, n, column);
  }
  // A row of zeros has no length that its slack could be compared with.
  bool is_known = std::all_of(t.scale_at, t.scale_at + t.m, [](double length) { return length > 0; });
  // No row changes sides, whatever its sign.
  fill_packs(t.stride, 0, t.leave);
  fill_packs(t.stride, 0, t.enter);
  const double roundings = static_cast<double>(piece.columns) * unit_roundoff,
               root = std::sqrt(static_cast<double>(n));
  for (Index j = 0; j < piece.columns && is_known; ++j) {
    fill_packs(t.ld, 0, t.z);
    fill_packs(t.stride, 0, t.level);
    (j < n ? t.z[j] : t.level[t.place[j - n]]) = 1;
    is_known = small_kernels().begin_again(t) && small_kernels().settle(t);
    double before[SmallTableau::most];
    Corrections known;
    for (int pass = 0; is_known && (pass < 2 || t.step > at_rounding * known.scale); ++pass) {
      std::copy_n(t.lambda, t.size, before);
      is_known = pass < most_corrections && correct(pass == 0, 0) && known.note(t);
    }
    double *const high = piece.high + j * piece.stride, *const low = piece.low + j * piece.stride;
    fill_packs(piece.stride, 0, high);
    fill_packs(piece.stride, 0, low);
    double square = 0;
    for (Index i = 0; i < n; ++i) {
      high[i] = t.q[i];
      low[i] = t.q_low[i];
      square += t.diagonal[i] * t.q[i] * t.q[i];
    }
    for (Index k = 0; k < t.size; ++k) {
      const DoubleDouble sum = two_sum(before[k], t.change[k]);
      high[n + k] = sum.hi;
      low[n + k] = sum.lo;
    }
    // Of sums of so many products in twice the working precision (Ogita, Rump and Oishi 2005), and of what
    // underflows.
    piece.error[j] = known.remaining + root * (2 * roundings * roundings * std::sqrt(square) +
                                               unit * std::numeric_limits<double>::min());
    is_known = is_known && std::isfinite(piece.error[j]);
  }
  for (Index a = 0; a < t.stride; ++a) {
    t.leave[a] = t.held[a] && !t.two_sided[a] ? -t.scale_at[a] : 0;
    t.enter[a] = t.held[a] ? 0 : t.inverse_scale[a];
  }
  return is_known;
}

const AffinePiece* SweptRows::take_affine_point() {
  SmallTableau& t = tableau_;
  if (!piece_ || piece_->columns != t.n + t.size || !std::equal(t.rows, t.rows + t.size, piece_->rows))
    return nullptr;
  small_kernels().take_affine_point(t, *piece_, problem_.z.data(), problem_.s.data());
  if (!looks_at_all()) measure_slacks_of_all();
  t.steps = 0;
  return piece_.get();
}

}  // namespace convex::inline pivoting
