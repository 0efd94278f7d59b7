#include <algorithm>
#include <cmath>

#include "convex/exact/elimination.hpp"
#include "convex/exact/fraction.hpp"
#include "convex/nearest_point/gallery/families.hpp"
#include "convex/nearest_point/gallery/planted.hpp"

namespace convex::inline families {
namespace {

constexpr int bits = 53;

/// HDHᵀ/b in blocks of b coordinates, H Hadamard's ±1 matrix, D powers of two from 1 down to 2^-range in
/// steps across the block: its eigenvalues are those of D, and all entries fit 53 bits.
Matrix inertia(Index n, int range) {
  Index block = 1;
  while (2 * block <= std::min<Index>(n, 16) && range + static_cast<int>(std::log2(2 * block)) <= bits - 1)
    block *= 2;
  Matrix A = Matrix::Zero(n, n);
  for (Index first = 0; first < n; first += block) {
    const Index size = std::min(block, n - first);
    for (Index k = 0; k < size; ++k) {
      const double place = static_cast<double>(k * (n / block) + first / block);
      const double value =
          std::exp2(-std::round(range * place / static_cast<double>(std::max<Index>(1, n - 1))));
      for (Index i = 0; i < size; ++i)
        for (Index j = 0; j < size; ++j) {
          const bool whole = size == block;
          const int signs = __builtin_popcountll(static_cast<unsigned long long>(i & k)) +
                            __builtin_popcountll(static_cast<unsigned long long>(j & k));
          if (whole)
            A(first + i, first + j) += (signs % 2 == 0 ? value : -value) / static_cast<double>(block);
          if (!whole && i == k && j == k) A(first + i, first + j) = value;
        }
    }
  }
  return A;
}

/// The solution v of K v = b for a regular K, as a nearest double and what is missing.
DoubleDoubleVector exact_solution(const Matrix& K, const Vector& b) {
  const Index n = b.size();
  Matrix rows(n, n + 1);
  rows << K, -b;
  IntegerRows integers;
  for (const ExactVector& row : exact_rows(rows)) integers.push_back(row.numerators);
  const Echelon kernel = annihilator(echelon(integers, at(n + 1)));
  DoubleDoubleVector v(n);
  if (kernel.rank() != 1) return DoubleDoubleVector(0);
  const IntegerVector& line = kernel.rows[0];
  const Integer& last = line.back();
  if (last.is_zero()) return DoubleDoubleVector(0);
  const bool negative = last.sign() < 0;
  const Integer denominator = negative ? -last : last;
  for (Index i = 0; i < n; ++i) {
    const Integer& entry = line[at(i)];
    const DoubleDouble pair = nearest_pair({negative ? -entry : entry, denominator});
    v.hi[i] = pair.hi;
    v.lo[i] = pair.lo;
  }
  return v;
}

}  // namespace

/// z is rounded, so the answer is not the one it was made from: it comes from the KKT system of the rows
/// held, in exact arithmetic on the data as they are. A draw whose signs are not strict is drawn again.
GalleryInstance ill_conditioned(Index n, double condition, std::uint32_t seed) {
  const int range = std::min(bits - 1, static_cast<int>(std::lround(std::log2(condition))));
  const Matrix A = inertia(n, range);
  const Index held = std::max<Index>(1, n / 4), m = 2 * n;
  for (std::uint32_t trial = 0;; ++trial) {
    Draw draw(seed + 1000003 * trial);
    PlantedRows rows(A, draw.integers(n, -8, 8));
    for (Index a = 0; a < held; ++a) {
      const Vector u = integer_row(n, draw);
      rows.add(u, draw.integer(1, 16), 0);
    }
    rows.add_apart(m - held, draw);
    GalleryInstance instance = rows.instance(draw);
    std::vector<Index> active;
    for (Index a = 0; a < m; ++a)
      if (instance.multipliers[a] > 0) active.push_back(a);
    const RowMatrix& U = instance.problem.U.dense();
    Matrix K = Matrix::Zero(n + held, n + held);
    Vector b(n + held);
    K.topLeftCorner(n, n) = A;
    b.head(n) = instance.problem.z;
    for (Index k = 0; k < held; ++k) {
      const Index a = active[at(k)];
      K.block(0, n + k, n, 1) = -U.row(a).transpose();
      K.block(n + k, 0, 1, n) = U.row(a);
      b[n + k] = instance.problem.s[a];
    }
    const DoubleDoubleVector truth = exact_solution(K, b);
    if (truth.size() == 0) continue;
    instance.solution.hi = truth.hi.head(n);
    instance.solution.lo = truth.lo.head(n);
    bool strict = truth.hi.tail(held).minCoeff() > 0x1p-20;
    for (Index k = 0; k < held; ++k) instance.multipliers[active[at(k)]] = truth.hi[n + k];
    const Vector slack = U * instance.solution.hi - instance.problem.s;
    for (Index a = 0; a < m; ++a) strict = strict && (instance.multipliers[a] > 0 || slack[a] > 0x1p-10);
    if (strict) return instance;
  }
}

}  // namespace convex::inline families
