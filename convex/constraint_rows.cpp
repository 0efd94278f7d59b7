#include "convex/constraint_rows.hpp"

#include <cmath>
#include <vector>

#include "convex/dense/dense_kernels.hpp"

namespace convex {

Index ConstraintRows::count() const { return is_sparse() ? sparse().rows() : dense().rows(); }

Index ConstraintRows::dimension() const { return is_sparse() ? sparse().cols() : dense().cols(); }

bool ConstraintRows::is_finite() const {
  const auto all_finite = dense_kernels().is_finite;
  return is_sparse() ? all_finite(sparse().nonZeros(), sparse().valuePtr())
                     : all_finite(dense().size(), dense().data());
}

Vector ConstraintRows::row(Index a) const {
  Vector u(dimension());
  copy_row(a, u);
  return u;
}

void ConstraintRows::copy_row(Index a, Eigen::Ref<Vector> into) const {
  if (!is_sparse()) {
    into = dense().row(a);
    return;
  }
  into.setZero();
  for (SparseRows::InnerIterator it(sparse(), a); it; ++it) into[it.col()] = it.value();
}

Vector ConstraintRows::times(const Vector& x) const {
  Vector product;
  times(x, product);
  return product;
}

void ConstraintRows::times(const Vector& x, Vector& into) const {
  into.resize(count());
  if (is_sparse())
    into.noalias() = sparse() * x;
  else
    into.noalias() = dense() * x;
}

Vector ConstraintRows::transpose_times(const Vector& lambda) const {
  if (is_sparse()) return sparse().transpose() * lambda;
  return dense().transpose() * lambda;
}

DoubleDouble ConstraintRows::dot(Index a, const DoubleDoubleVector& x) const {
  if (!is_sparse()) return convex::dot(dimension(), dense().row(a).data(), x.hi.data(), x.lo.data());
  RunningSum sum;
  for (SparseRows::InnerIterator it(sparse(), a); it; ++it) {
    sum.add(two_product(it.value(), x.hi[it.col()]));
    sum.lo += it.value() * x.lo[it.col()];
  }
  return sum.tidy();
}

void ConstraintRows::add_multiple(Index a, DoubleDouble c, DoubleDoubleVector& sum) const {
  if (!is_sparse()) {
    convex::add_multiple(dimension(), dense().row(a).data(), c, sum.hi.data(), sum.lo.data());
    return;
  }
  for (SparseRows::InnerIterator it(sparse(), a); it; ++it)
    accumulate_product(it.value(), c, sum.hi[it.col()], sum.lo[it.col()]);
}

double ConstraintRows::absolute_dot(Index a, const Vector& weight) const {
  if (!is_sparse()) return dense().row(a).cwiseAbs() * weight;
  double sum = 0;
  for (SparseRows::InnerIterator it(sparse(), a); it; ++it) sum += std::abs(it.value()) * weight[it.col()];
  return sum;
}

Vector ConstraintRows::lengths(const Vector& weight) const {
  if (count() == 0) return Vector(0);  // those that there are none of may have no columns
  if (is_sparse()) return (sparse().cwiseAbs2() * weight).cwiseSqrt();
  return (dense().cwiseAbs2() * weight).cwiseSqrt();
}

ConstraintRows ConstraintRows::select(const std::vector<Index>& rows) const {
  const Index count = static_cast<Index>(rows.size());
  if (!is_sparse()) {
    RowMatrix chosen(count, dimension());
    for (Index k = 0; k < count; ++k) chosen.row(k) = dense().row(rows[static_cast<std::size_t>(k)]);
    return ConstraintRows(std::move(chosen));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (Index k = 0; k < count; ++k)
    for (SparseRows::InnerIterator it(sparse(), rows[static_cast<std::size_t>(k)]); it; ++it)
      entries.emplace_back(static_cast<int>(k), static_cast<int>(it.col()), it.value());
  SparseRows chosen(count, dimension());
  chosen.setFromTriplets(entries.begin(), entries.end());
  return ConstraintRows(std::move(chosen));
}

}  // namespace convex
