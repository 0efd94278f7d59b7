#pragma once

#include <vector>

#include "convex/metric.hpp"

namespace mechanics::inline motions {

using convex::Index;
using convex::Vector;

/// Rows u_a held with equality in the metric A, factored once for many right-hand sides: with W = F⁻¹Uᵀ,
/// A = F Fᵀ, whitened rows are made orthonormal, W = Q R (Gram and Schmidt, twice).
class HeldRows {
 public:
  /// U: one row a held constraint, in the order of preference: a row that rounding cannot tell from a
  /// combination of those before it is left out.
  HeldRows(const convex::Metric& A, const std::vector<Vector>& U);

  /// The rows that count, as indices into U.
  const std::vector<Index>& independent() const { return independent_; }
  Index count() const { return static_cast<Index>(independent_.size()); }

  /// A x = r + Uᵀ lambda, U x = s. lambda: one number per row given, 0 for rows left out. r: n; s: one per
  /// row given.
  struct Answer {
    Vector x, lambda;
  };
  Answer solve(const Vector& r, const Vector& s) const;
  /// The least change in the metric with U x = s: r = 0.
  Vector least_change(const Vector& s) const { return solve(Vector::Zero(dimension_), s).x; }

 private:
  convex::Metric A_;
  Index dimension_, given_;
  std::vector<Index> independent_;
  convex::Matrix Q_, R_;
};

}  // namespace mechanics::inline motions
