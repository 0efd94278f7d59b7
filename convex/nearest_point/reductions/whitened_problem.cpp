#include "convex/nearest_point/reductions/whitened_problem.hpp"

#include "convex/nearest_point/active_set/working_set.hpp"

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

}  // namespace convex::inline reductions
