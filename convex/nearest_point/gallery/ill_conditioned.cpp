#include <algorithm>
#include <cmath>

#include "convex/exact/fraction.hpp"
#include "convex/nearest_point/gallery/families.hpp"
#include "convex/nearest_point/gallery/planted.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"

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

}  // namespace

/// z is rounded, so the answer is not the one it was made from: it is solved for in fractions, on the data as
/// they are. A draw whose signs are not strict is drawn again.
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
    const ExactSolution truth = exact_active_set(exact_problem(instance.problem), active);
    const std::vector<bool> is_held = marked(m, active);
    instance.multipliers = nearest(truth.lambda);
    bool strict = true;
    for (Index a = 0; a < m; ++a)
      strict = strict && (is_held[at(a)] ? instance.multipliers[a] > 0x1p-20
                                         : nearest_double(truth.slack[at(a)]) > 0x1p-10);
    if (!strict) continue;
    instance.solution = nearest_pairs(truth.q);
    return instance;
  }
}

}  // namespace convex::inline families
