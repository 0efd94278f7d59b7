#pragma once

#include <cstring>
#include <span>

#include "convex/vector.hpp"

namespace convex::inline dense {

/// n rounded up to whole packs of eight.
constexpr Index padded(Index n) { return (n + 7) / 8 * 8; }

/// Copies and fills n doubles, a multiple of 8: short ones are done before the library's function is entered.
inline void copy_packs(Index n, const double* from, double* to) {
  for (Index i = 0; i < n; i += 8) std::memcpy(to + i, from + i, 8 * sizeof(double));
}
inline void fill_packs(Index n, double value, double* to) {
  for (Index i = 0; i < n; i += 8)
    for (Index k = 0; k < 8; ++k) to[i + k] = value;
}

/// Kernels on dense data for one processor family. Sums are taken in an order that is the same for all of
/// them, products and sums are rounded apart, so all give the same bytes. Eight doubles are a pack.
///
/// A triangle stands in an ld×ld matrix by columns, ld a multiple of 8 no less than n: L in the lower part,
/// Lᵀ in the upper one, the unit matrix up to padded(n); `inverse` has the inverse of each 8×8 block on the
/// diagonal by columns, and its transpose, 128 numbers for a block. Vectors x are padded with zeros. Eight
/// vectors side by side, X: n packs, pack i has entry i of each.
struct DenseKernels {
  /// Factors W = L Lᵀ in place, W in the lower part of T. A pivot that is not positive leaves numbers that
  /// are not finite.
  void (*factor)(Index n, Index ld, double* T, double* inverse);
  /// `inverse` of a triangle.
  void (*invert_blocks)(Index n, Index ld, const double* T, double* inverse);
  /// x := L⁻¹x.
  void (*forward)(Index n, Index ld, const double* T, const double* inverse, double* x);
  /// x := L⁻ᵀx.
  void (*backward)(Index n, Index ld, const double* T, const double* inverse, double* x);
  /// X := L⁻¹X for eight vectors side by side.
  void (*forward_pack)(Index n, Index ld, const double* T, const double* inverse, double* X);
  /// X := L⁻ᵀX.
  void (*backward_pack)(Index n, Index ld, const double* T, const double* inverse, double* X);
  /// into[l·stride + k] := X_k·Y_l, k, l < 8.
  void (*gram)(Index n, const double* X, const double* Y, double* into, Index stride);
  /// into_k := X_k·y, k < 8.
  void (*dots)(Index n, const double* X, const double* y, double* into);
  /// w_i += Σ_k X_k[i] y_k over `count` blocks of eight vectors side by side, one after the other.
  void (*combine)(Index n, Index count, const double* X, const double* y, double* w);
  /// y += c x, n a multiple of 8.
  void (*add_multiple)(Index n, double c, const double* x, double* y);
  /// Σ x_i y_i, n a multiple of 8.
  double (*dot)(Index n, const double* x, const double* y);
  /// into_a := u_a·x - s_a for the m rows of U (m×n by rows).
  void (*slacks)(Index m, Index n, const double* U, const double* x, const double* s, double* into);
  /// into_a := Σ_i u_ai² weight_i.
  void (*squares)(Index m, Index n, const double* U, const double* weight, double* into);
  /// into := z + Σ_k lambda_k u_(row k) - A q, sums in twice the working precision, rounded once. A: n×n by
  /// columns; U: m×n by rows.
  void (*stationarity)(Index n, const double* A, const double* q, Index m, const double* U, Index count,
                       const Index* rows, const double* lambda, const double* z, double* into);
  /// The same in doubles alone.
  void (*residual)(Index n, const double* A, const double* q, Index m, const double* U, Index count,
                   const Index* rows, const double* lambda, const double* z, double* into);
  /// into_k := X_k·q - s_k, k < 8, sums in twice the working precision, rounded once.
  void (*precise_slacks)(Index n, const double* X, const double* q, const double* s, double* into);
  /// y += Σ_k c_(column k) X_(column k) over `count` columns of n numbers, a multiple of 8, `stride` apart.
  void (*add_columns)(Index n, Index count, const Index* columns, const double* c, const double* X,
                      Index stride, double* y);
  /// X := up to eight of the m rows of U side by side, n packs, filled with zeros.
  void (*side_by_side)(Index n, Index m, const double* U, const Index* rows, Index count, double* X);
  /// Whether eight vectors side by side are sums of `count` rows of U with whole numbers as coefficients; c:
  /// eight for each row, guesses, of which these numbers are made, 0 where c_jk length_j <= least_k; those of
  /// the rows with others than 0, `terms`, come first. size_k: 1 and the sum of their sizes, infinite where a
  /// guess is more than `close` off, as a part of the larger of itself and 1. In doubles, rest_k:
  /// Σ_i |Σ_j c_jk u_(row j)i - X_ki|, and load_k: Σ_j c_jk s_(row j) - s_k.
  void (*whole_sums)(Index n, const double* X, const double* s_of_X, const double* U, const double* s,
                     Index count, const Index* rows, const double* length, const double* least, double close,
                     double* c, Index* terms, double* size, double* rest, double* load);
  /// Whether Σ_k c_k u_(row k) - whole u_p is 0 in doubles, entry by entry, over `count` rows of n numbers.
  bool (*cancels)(Index n, const double* U, Index p, double whole, Index count, const Index* rows,
                  const double* c);
  /// Whether none of the m rows of U begins with 0.
  bool (*first_entries_differ_from_zero)(Index m, Index n, const double* U);
  /// max |x_i| of n numbers.
  double (*largest_size)(Index n, const double* x);
  /// Whether adding `shift` rounds none of n numbers.
  bool (*is_on_grid)(Index n, const double* x, double shift);
  /// Whether all of n numbers are finite.
  bool (*is_finite)(Index n, const double* x);
  /// T := A, n×n by columns, padded. Whether A is its own transpose, not one bit off, and finite.
  bool (*take_symmetric)(Index n, Index ld, const double* A, double* T);
};

/// Those for the processor that the program runs on.
const DenseKernels& dense_kernels();

/// All that this processor can run.
std::span<const DenseKernels* const> all_dense_kernels();

}  // namespace convex::inline dense
