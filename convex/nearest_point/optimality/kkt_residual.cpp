#include "convex/nearest_point/optimality/kkt_residual.hpp"

namespace convex::inline optimality {

Vector stationarity_residual(const NearestPointProblem& problem, const DoubleDoubleVector& q,
                             const std::vector<Index>& rows, const DoubleDoubleVector& lambda) {
  const Index n = problem.dimension();
  DoubleDoubleVector sum(problem.z);
  for (std::size_t k = 0; k < rows.size(); ++k)
    problem.U.add_multiple(rows[k], lambda[static_cast<Index>(k)], sum);
  switch (problem.A.kind()) {
    case MetricKind::identity:
      return ((sum.hi - q.hi) + (sum.lo - q.lo)).eval();
    case MetricKind::diagonal: {
      const Vector& d = problem.A.diagonal();
      for (Index i = 0; i < n; ++i) accumulate_product(d[i], {-q.hi[i], -q.lo[i]}, sum.hi[i], sum.lo[i]);
      break;
    }
    case MetricKind::dense: {
      const Matrix& A = problem.A.dense_gram();
      for (Index j = 0; j < n; ++j)
        add_multiple(n, A.col(j).data(), {-q.hi[j], -q.lo[j]}, sum.hi.data(), sum.lo.data());
      break;
    }
    case MetricKind::sparse: {
      const SparseMatrix& A = problem.A.sparse_gram();
      for (Index j = 0; j < n; ++j) {  // a column is a row
        double hi = sum.hi[j], lo = sum.lo[j];
        for (SparseMatrix::InnerIterator it(A, j); it; ++it)
          accumulate_product(it.value(), {-q.hi[it.row()], -q.lo[it.row()]}, hi, lo);
        sum.hi[j] = hi;
        sum.lo[j] = lo;
      }
      break;
    }
  }
  return sum.value();
}

Vector stationarity_residual(const NearestPointProblem& problem, const DoubleDoubleVector& q,
                             const Vector& lambda) {
  std::vector<Index> loaded;
  for (Index a = 0; a < lambda.size(); ++a)
    if (lambda[a] != 0) loaded.push_back(a);
  return stationarity_residual(problem, q, loaded, DoubleDoubleVector(lambda(loaded)));
}

DoubleDouble slack(const NearestPointProblem& problem, Index a, const DoubleDoubleVector& q) {
  return add(problem.U.dot(a, q), {-problem.s[a], 0});
}

}  // namespace convex::inline optimality
