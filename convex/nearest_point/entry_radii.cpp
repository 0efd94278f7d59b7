#include "convex/nearest_point/entry_radii.hpp"

namespace convex {
namespace {

Eigen::Map<const Vector> entries(const SparseMatrix& M) { return {M.valuePtr(), M.nonZeros()}; }
Eigen::Map<const Vector> entries(const SparseRows& M) { return {M.valuePtr(), M.nonZeros()}; }

}  // namespace

DataRadii EntryRadii::by_rows(const Metric& metric) const {
  return {longest_within(ConstraintRows(U), metric), s};
}

bool EntryRadii::is_finite() const {
  return entries(A).allFinite() && z.allFinite() && entries(U).allFinite() && s.allFinite();
}

bool EntryRadii::is_zero() const {
  return (entries(A).array() == 0).all() && (z.array() == 0).all() && (entries(U).array() == 0).all() &&
         (s.array() == 0).all();
}

}  // namespace convex
