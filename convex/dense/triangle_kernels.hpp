#pragma once

#include "convex/dense/packs.hpp"

namespace convex::inline dense {

/// The Cholesky factor of the lower triangle of C, 8×8 by columns, of which the first `width` rows and
/// columns are there.
void factor_block(Index width, double* C);

alignas(64) inline constexpr double unit_block[64] = {
    1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0,
    0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1};

/// The kernels of `DenseKernels` on triangles, by blocks of eight. The inverse of each 8×8 block on the
/// diagonal makes a solve with it a product, whose terms do not wait for each other.
template <int W, bool Fused>
struct TriangleKernels : Packs<W, Fused> {
  using P = Packs<W, Fused>;
  using Pack = typename P::Pack;

  /// Columns of a block at a time, as registers allow.
  static constexpr int together = W == 8 ? 8 : 4;

  /// Takes from some columns, from j on, of a pack of rows what the `before` columns before contribute.
  MOREAU_INLINE void subtract_before(Index before, Index ld, const double* T, Index j, Index row,
                                     Pack (&column)[together]) {
    const double *l = T + row, *across = T + j;
    for (Index p = 0; p < before; ++p, l += ld, across += ld) {
      const Pack x = P::load(l);
#pragma GCC unroll 8
      for (int c = 0; c < together; ++c) P::subtract_product(column[c], x, across[c]);
    }
  }

  /// inverse: the inverse of a lower triangle L, at T by columns, the unit matrix from `width` on; then its
  /// transpose.
  MOREAU_INLINE void invert_block(Index width, Index ld, const double* T, double* inverse) {
    Pack row[8];  // of the inverse
#pragma GCC unroll 8
    for (int r = 0; r < 8; ++r) row[r] = P::load(unit_block + 8 * r);
#pragma GCC unroll 8
    for (int r = 0; r < 8; ++r) {
      if (r >= width) break;
#pragma GCC unroll 8
      for (int c = 0; c < r; ++c) P::subtract_product(row[r], row[c], T[c * ld + r]);
      row[r] = P::times(row[r], 1 / T[r * (ld + 1)]);
    }
#pragma GCC unroll 8
    for (int r = 0; r < 8; ++r) P::store(inverse + 64 + 8 * r, row[r]);
    P::transpose(row);
#pragma GCC unroll 8
    for (int r = 0; r < 8; ++r) P::store(inverse + 8 * r, row[r]);
  }

  /// The factor of a block on the diagonal and its transpose to where they belong.
  MOREAU_INLINE void place_block(Index ld, const double* L, double* T) {
    Pack across[8];
#pragma GCC unroll 8
    for (int c = 0; c < 8; ++c) across[c] = P::load(L + 8 * c);
    P::transpose(across);
#pragma GCC unroll 8
    for (int c = 0; c < 8; ++c) P::store(T + c * ld, P::joined(across[c], P::load(L + 8 * c), c));
  }

  MOREAU_INLINE void factor(Index n, Index ld, double* T, double* inverse) {
    for (Index j = 0; j < n; j += 8, inverse += 128) {
      const Index columns = n - j < 8 ? n - j : 8;
      for (Index row = j; row < n; row += 8) {
        double B[64];  // eight columns of the pack of rows
        for (int first = 0; first < 8; first += together) {
          Pack column[together];
#pragma GCC unroll 8
          for (int c = 0; c < together; ++c) column[c] = P::load(T + (j + first + c) * ld + row);
          subtract_before(j, ld, T, j + first, row, column);
#pragma GCC unroll 8
          for (int c = 0; c < together; ++c) P::store(B + 8 * (first + c), column[c]);
        }
        if (row == j) {
          factor_block(columns, B);
          invert_block(columns, 8, B, inverse);
          place_block(ld, B, T + j * (ld + 1));
          continue;
        }
        Pack across[8];
        for (int first = 0; first < 8; first += together) {  // B L⁻ᵀ
          Pack column[together];
          P::clear(column);
          for (int d = 0; d < first + together; ++d) {
            const Pack x = P::load(B + 8 * d);
#pragma GCC unroll 8
            for (int c = 0; c < together; ++c) P::add_product(column[c], x, inverse[8 * d + first + c]);
          }
#pragma GCC unroll 8
          for (int c = 0; c < together; ++c) {
            P::store(T + (j + first + c) * ld + row, column[c]);
            across[first + c] = column[c];
          }
        }
        P::transpose(across);
#pragma GCC unroll 8
        for (int i = 0; i < 8; ++i) P::store(T + (row + i) * ld + j, across[i]);
      }
    }
  }

  MOREAU_INLINE void invert_blocks(Index n, Index ld, const double* T, double* inverse) {
    for (Index j = 0; j < n; j += 8)
      invert_block(n - j < 8 ? n - j : 8, ld, T + j * (ld + 1), inverse + 16 * j);
  }

  MOREAU_INLINE void forward(Index n, Index ld, const double* T, const double* inverse, double* x) {
    for (Index j = 0; j < n; j += 8, T += 8 * ld) {
      double solved[8];  // of which the compiler knows that nothing below changes it
      P::store(solved, P::block_times(inverse + 16 * j, x + j));
      P::store(x + j, P::load(solved));
      for (Index row = j + 8; row < n; row += 8) {
        Pack sum = P::load(x + row);
#pragma GCC unroll 8
        for (int c = 0; c < 8; ++c) P::subtract_product(sum, P::load(T + c * ld + row), solved[c]);
        P::store(x + row, sum);
      }
    }
  }

  MOREAU_INLINE void backward(Index n, Index ld, const double* T, const double* inverse, double* x) {
    for (Index j = (n - 1) / 8 * 8; j >= 0; j -= 8) {
      double solved[8];
      P::store(solved, P::block_times(inverse + 16 * j + 64, x + j));
      P::store(x + j, P::load(solved));
      for (Index row = 0; row < j; row += 8) {
        Pack sum = P::load(x + row);
#pragma GCC unroll 8
        for (int c = 0; c < 8; ++c) P::subtract_product(sum, P::load(T + (j + c) * ld + row), solved[c]);
        P::store(x + row, sum);
      }
    }
  }

  MOREAU_INLINE void forward_pack(Index n, Index ld, const double* T, const double* inverse, double* X) {
    forward_packs<1>(n, ld, T, inverse, X, 0);
  }

  /// The same for `count` times eight vectors, `apart` doubles from each other: each waits for its own
  /// entries alone.
  template <int count>
  MOREAU_INLINE void forward_packs(Index n, Index ld, const double* T, const double* inverse, double* X,
                                   Index apart) {
    Index i = 0;
    for (; i + 8 <= n && W == 8 && count == 1; i += 8) forward_rows<8, count>(i, ld, T, inverse, X, apart);
    for (; i + 4 <= n; i += 4) forward_rows<4, count>(i, ld, T, inverse, X, apart);
    if (n - i == 1) forward_rows<1, count>(i, ld, T, inverse, X, apart);
    if (n - i == 2) forward_rows<2, count>(i, ld, T, inverse, X, apart);
    if (n - i == 3) forward_rows<3, count>(i, ld, T, inverse, X, apart);
  }
  template <int rows, int count>
  MOREAU_INLINE void forward_rows(Index i, Index ld, const double* T, const double* inverse, double* X,
                                  Index apart) {
    const double* const row = T + i * ld;
    Pack sum[rows * count];
#pragma GCC unroll 8
    for (int r = 0; r < rows * count; ++r) sum[r] = P::load(X + r % count * apart + 8 * (i + r / count));
    for (Index j = 0; j < i; ++j) {
      Pack x[count];
#pragma GCC unroll 2
      for (int k = 0; k < count; ++k) x[k] = P::load(X + k * apart + 8 * j);
#pragma GCC unroll 8
      for (int r = 0; r < rows * count; ++r)
        P::subtract_product(sum[r], x[r % count], row[r / count * ld + j]);
    }
#pragma GCC unroll 8
    for (int r = 0; r < rows; ++r)
#pragma GCC unroll 2
      for (int k = 0; k < count; ++k) {
        Pack& own = sum[r * count + k];
        for (int c = 0; c < r; ++c) P::subtract_product(own, sum[c * count + k], row[r * ld + i + c]);
        own = P::times(own, inverse[(i + r) / 8 * 128 + (i + r) % 8 * 9]);
        P::store(X + k * apart + 8 * (i + r), own);
      }
  }

  MOREAU_INLINE void backward_pack(Index n, Index ld, const double* T, const double* inverse, double* X) {
    const auto reciprocal = [&](Index i) { return inverse[i / 8 * 128 + i % 8 * 9]; };
    Index i = n;
    for (; i >= 4; i -= 4) {
      Pack sum[4];
      const double* column = T + (i - 4) * ld;
#pragma GCC unroll 4
      for (int r = 0; r < 4; ++r) sum[r] = P::load(X + 8 * (i - 4 + r));
      for (Index j = i; j < n; ++j) {
        const Pack x = P::load(X + 8 * j);
#pragma GCC unroll 4
        for (int r = 0; r < 4; ++r) P::subtract_product(sum[r], x, column[r * ld + j]);
      }
#pragma GCC unroll 4
      for (int r = 3; r >= 0; --r) {
        for (int c = 3; c > r; --c) P::subtract_product(sum[r], sum[c], column[r * ld + i - 4 + c]);
        sum[r] = P::times(sum[r], reciprocal(i - 4 + r));
        P::store(X + 8 * (i - 4 + r), sum[r]);
      }
    }
    while (i-- > 0) {
      Pack sum = P::load(X + 8 * i);
      for (Index j = i + 1; j < n; ++j) P::subtract_product(sum, P::load(X + 8 * j), T[i * ld + j]);
      P::store(X + 8 * i, P::times(sum, reciprocal(i)));
    }
  }
};

}  // namespace convex::inline dense
