#include <cmath>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/proved_prox/doubles/metric_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"

namespace convex::near_graphs {

/// ½ x·Qx + c·x + constant at x itself.
MaybeNear of_quadratic(const IntervalArguments& a, const Vector& x) {
  Index columns = 0;
  const std::vector<Interval> Q = a.matrix("Q", columns), c = a.vector("c");
  const auto at = [&](Index i, Index j) -> const Interval& {
    return Q[static_cast<std::size_t>(i * columns + j)];
  };
  NearGraph made(x, x);
  for (Index i = 0; i < x.size(); ++i) {
    Interval slope = c[static_cast<std::size_t>(i)];
    for (Index j = 0; j < columns; ++j) {
      if (at(i, j).low != at(j, i).low || at(i, j).high != at(j, i).high) return std::nullopt;
      slope = slope + at(i, j) * interval_at(x[j]);
    }
    made.set_v(i, slope);
    made.f_x = made.f_x + interval_at(0.5 * x[i]) * (slope + c[static_cast<std::size_t>(i)]);
  }
  made.f_x = made.f_x + a.number("constant");
  return made;
}

/// {Ax = b}: the nearest point of it to x is at |b - Ax|/σ at most, σ² below the eigenvalues of AAᵀ; Aᵀμ is a
/// normal for any μ. For rows that are independent, and numbers that are doubles.
MaybeNear of_affine(const IntervalArguments& a, const Vector& x, const Vector& v) {
  Index columns = 0;
  const std::vector<Interval> entries = a.matrix("A", columns), b = a.vector("b");
  const Index rows = static_cast<Index>(entries.size()) / std::max<Index>(columns, 1);
  if (rows == 0 || rows > columns) return std::nullopt;
  Matrix A(rows, columns);
  Vector miss(rows);
  for (Index i = 0; i < rows; ++i) {
    Interval left = b[b.size() == 1 ? 0 : static_cast<std::size_t>(i)];
    for (Index j = 0; j < columns; ++j) {
      const Interval& entry = entries[static_cast<std::size_t>(i * columns + j)];
      if (entry.low != entry.high) return std::nullopt;
      A(i, j) = entry.low;
      left = left - entry * interval_at(x[j]);
    }
    miss[i] = largest_size(left);
  }
  if (!is_ordinary(A)) return std::nullopt;
  const Matrix gram = A * A.transpose();
  const double least =
      least_eigenvalue_below(gram) - above(gamma(columns) * (A.cwiseAbs() * A.cwiseAbs().transpose()).norm());
  if (!(least > 0)) return std::nullopt;
  NearGraph made(x, v);
  made.x_ball = above(norm_above(miss) / std::sqrt(least));
  const Vector mu = Metric::dense(gram).solve(A * v);
  made.v = A.transpose() * mu;
  made.v_radius = (gamma(rows) * (A.cwiseAbs().transpose() * mu.cwiseAbs())).array() * (1 + 0x1p-30) + 1e-300;
  return made;
}

}  // namespace convex::near_graphs
