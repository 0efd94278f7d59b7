#include "convex/nearest_point/optimality/complementarity.hpp"

#include "convex/linear_algebra/complete_orthogonal.hpp"

namespace convex::inline optimality {

Complementarity::Complementarity(const WhitenedProblem& white) {
  for (Index a = 0; a < white.size(); ++a)
    if (!white.is_free(a)) columns.push_back(a);
  const std::vector<Index> free = white.free_columns();
  V = white.V(Eigen::all, columns);
  b = white.b(columns);
  if (!free.empty()) {
    const Matrix fixed = white.V(Eigen::all, free);
    const linear_algebra::CompleteOrthogonal factor(fixed.transpose());
    const Vector shift = factor.solve(white.b(free));
    b -= V.transpose() * shift;
    for (int pass = 0; pass < 2; ++pass) V -= factor.solve_columns(fixed.transpose() * V);
  }
  M = V.transpose() * V;
}

Vector Complementarity::with_free(const WhitenedProblem& white, const Vector& y) const {
  Vector all = Vector::Zero(white.size());
  all(columns) = y;
  const std::vector<Index> free = white.free_columns();
  if (free.empty()) return all;
  const Matrix fixed = white.V(Eigen::all, free);
  // V_free y_free = shift - P V y: the least-norm solution, where columns depend on each other.
  const linear_algebra::CompleteOrthogonal equations(fixed.transpose()), map(fixed);
  all(free) = map.solve(equations.solve(Vector(white.b(free)) - fixed.transpose() * (white.V * all)));
  return all;
}

}  // namespace convex::inline optimality
