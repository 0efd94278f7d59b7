#include "convex/nearest_point/reductions/scaled_problem.hpp"

namespace convex::inline reductions {

ConstraintRows divided(const ConstraintRows& U, const std::vector<Index>& rows, const Vector& length) {
  ConstraintRows chosen = U.select(rows);
  const Vector factor = length.cwiseInverse();
  if (chosen.is_sparse()) return ConstraintRows(SparseRows(factor.asDiagonal() * chosen.sparse()));
  return ConstraintRows(RowMatrix(factor.asDiagonal() * chosen.dense()));
}

ScaledProblem::ScaledProblem(const NearestPointProblem& original)
    : problem{original.A, original.z, {}, {}, {}} {
  original_rows = original.rows();
  const Vector all = original.U.lengths(original.A.diagonal().cwiseInverse());
  const std::vector<bool> is_two_sided = marked(original_rows, original.two_sided);
  for (Index a = 0; a < original_rows; ++a)
    if (all[a] > 0) rows.push_back(a);
  length = all(rows);
  problem.U = divided(original.U, rows, length);
  problem.s = original.s(rows).cwiseQuotient(length);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    two_sided.push_back(is_two_sided[at(rows[k])]);
    if (two_sided.back()) problem.two_sided.push_back(static_cast<Index>(k));
  }
  const Vector gap = problem.s - problem.U.times(problem.A.solve(problem.z));
  const double largest = gap.size() > 0 ? gap.cwiseAbs().maxCoeff() : 0;
  if (largest > 0) unit = largest;
  problem.z /= unit;
  problem.s /= unit;
}

Vector ScaledRows::multipliers(const Vector& lambda) const {
  Vector found = Vector::Zero(original_rows);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Index i = static_cast<Index>(k);
    found[rows[k]] = lambda[i] * unit / length[i];
  }
  return found;
}

}  // namespace convex::inline reductions
