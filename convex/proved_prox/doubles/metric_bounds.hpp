#pragma once

#include "convex/metric.hpp"

namespace convex::near_graphs {

/// A number below the least eigenvalue of W, 0 where none above 0 is proved: Cholesky's method in doubles on
/// W - shift I without a negative pivot proves λ_min(W) > shift - γ tr(W) (Rump 2006; Higham 2002, theorem
/// 10.3).
double least_eigenvalue_below(const Matrix& W);

/// Norms in a metric, bounded from above in doubles. W is meant to a relative error in every entry: 0, or
/// half a unit of the last place.
class MetricBounds {
 public:
  MetricBounds(const Metric& W, double relative_error);

  /// ||d||_W for all |d_i| <= size_i: n.
  double norm_above(const Vector& size) const;
  /// ||d'||_W for |d'_i - d_i| <= radius_i.
  double norm_above(const Vector& d, const Vector& radius) const;
  /// ||d||_W for |d|₂ <= ball.
  double norm_above(double ball) const;
  /// ||c'||_(W⁻¹) for all |c'_i - c_i| <= radius_i.
  double dual_norm_above(const Vector& c, const Vector& radius) const;
  double dual_norm_above(double ball) const;
  /// W x' for |x'_i - x_i| <= radius_i; the result replaces x.
  void multiply(Vector& x, Vector& radius) const;
  /// False where W is not proved positive definite; bounds of dual norms are then infinite.
  bool is_proved_definite() const { return least_ > 0; }
  const Metric& metric() const { return W_; }

 private:
  bool is_diagonal() const;
  Metric W_;
  Matrix gram_, sizes_;  ///< W and |W|, where it is not diagonal
  double error_, least_, most_;
};

}  // namespace convex::near_graphs
