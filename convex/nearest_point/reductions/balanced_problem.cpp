#include "convex/nearest_point/reductions/balanced_problem.hpp"

#include <cmath>

namespace convex::inline reductions {

SparseMatrix sparse_gram(const Metric& A) {
  if (A.kind() == MetricKind::sparse) return A.sparse_gram();
  if (A.kind() == MetricKind::dense) return A.dense_gram().sparseView(1, 0);
  SparseMatrix W(A.dimension(), A.dimension());
  W.setIdentity();
  W.diagonal() = A.diagonal();
  return W;
}

namespace {

double largest(const Vector& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0; }

}  // namespace

BalancedProblem balanced_problem(const NearestPointProblem& problem) {
  BalancedProblem scaled;
  const Vector root = problem.A.diagonal().cwiseSqrt();
  scaled.A = sparse_gram(problem.A);
  for (Index j = 0; j < scaled.A.outerSize(); ++j)
    for (SparseMatrix::InnerIterator it(scaled.A, j); it; ++it)
      it.valueRef() = it.row() == j ? 1 : it.value() / root[it.row()] / root[j];
  scaled.U = problem.U.is_sparse() ? problem.U.sparse() : SparseRows(problem.U.dense().sparseView(1, 0));
  Vector length(problem.rows());
  for (Index a = 0; a < problem.rows(); ++a) {
    double square = 0;
    for (SparseRows::InnerIterator it(scaled.U, a); it; ++it) {
      it.valueRef() /= root[it.col()];
      square += it.value() * it.value();
    }
    length[a] = square > 0 ? std::sqrt(square) : 1;
    for (SparseRows::InnerIterator it(scaled.U, a); it; ++it) it.valueRef() /= length[a];
  }
  scaled.z = problem.z.cwiseQuotient(root);
  scaled.s = problem.s.cwiseQuotient(length);
  double unit = std::max(largest(scaled.z), largest(scaled.s));
  if (!(unit > 0)) unit = 1;
  scaled.z /= unit;
  scaled.s /= unit;
  scaled.coordinate = unit * root.cwiseInverse();
  scaled.linear = unit * root;
  scaled.bound = unit * length;
  scaled.multiplier = unit * length.cwiseInverse();
  scaled.two_sided = marked(problem.rows(), problem.two_sided);
  return scaled;
}

}  // namespace convex::inline reductions
