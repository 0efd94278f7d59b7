#include "convex/nearest_point/reductions/whitened_problem.hpp"

#include "convex/linear_algebra/complete_orthogonal.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"

namespace convex::inline reductions {

WhitenedProblem::WhitenedProblem(const NearestPointProblem& problem) {
  const Index n = problem.dimension(), m = problem.rows();
  const Matrix all = whitened_rows(problem, indices_below(m));
  const Vector lengths = all.colwise().norm(), w_free = problem.A.whiten(problem.z);
  const std::vector<bool> is_two_sided = marked(m, problem.two_sided);
  original_rows = m;
  for (Index a = 0; a < m; ++a)
    if (lengths[a] > 0) {
      rows.push_back(a);
      two_sided.push_back(is_two_sided[at(a)]);
    }
  const Index k = static_cast<Index>(rows.size());
  V.resize(n, k);
  b.resize(k);
  length.resize(k);
  for (Index j = 0; j < k; ++j) {
    const Index a = rows[at(j)];
    length[j] = lengths[a];
    V.col(j) = all.col(a) / lengths[a];
    b[j] = problem.s[a] / lengths[a] - V.col(j).dot(w_free);
  }
  if (k > 0 && b.cwiseAbs().maxCoeff() > 0) unit = b.cwiseAbs().maxCoeff();
  b /= unit;
}

std::vector<Index> WhitenedProblem::free_columns() const {
  std::vector<Index> columns;
  for (Index a = 0; a < size(); ++a)
    if (is_free(a)) columns.push_back(a);
  return columns;
}

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

}  // namespace convex::inline reductions
