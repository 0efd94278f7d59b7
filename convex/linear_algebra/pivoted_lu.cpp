#include "convex/linear_algebra/pivoted_lu.hpp"

#include <Eigen/LU>

namespace convex::linear_algebra {

PivotedLu::PivotedLu(const Matrix& A) {
  if (!A.allFinite()) return;
  LU_ = A;
  const Eigen::PartialPivLU<Eigen::Ref<Matrix>> lu(LU_);
  row_.assign(lu.permutationP().indices().begin(), lu.permutationP().indices().end());
  is_regular_ = LU_.allFinite() && (LU_.diagonal().array() != 0).all();
}

Vector PivotedLu::solve(const Vector& b) const {
  Vector x(b.size());
  for (Index i = 0; i < b.size(); ++i) x[row_[static_cast<std::size_t>(i)]] = b[i];
  LU_.triangularView<Eigen::UnitLower>().solveInPlace(x);
  LU_.triangularView<Eigen::Upper>().solveInPlace(x);
  return x;
}

}  // namespace convex::linear_algebra
