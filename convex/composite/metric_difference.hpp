#pragma once

#include "convex/double_double.hpp"
#include "convex/metric.hpp"

namespace convex::inline composite {

/// sum += W(x - z), sum of at least n entries, in twice the working precision: where W is ill-conditioned
/// plain sums would lose what the dual norm of the covector sees.
void add_metric_difference(const Metric& W, const Vector& x, const Vector& z, DoubleDoubleVector& sum);

/// W(x - z), rounded once.
Vector metric_difference(const Metric& W, const Vector& x, const Vector& z);

/// W⁻¹c, refined by residuals in twice the working precision until they leave rounding (Wilkinson 1963): once
/// in most metrics, more often where the condition number leaves a few digits.
Vector refined_solve(const Metric& W, const Vector& c);

/// Wx - c, rounded once.
Vector excess_of_image(const Metric& W, const Vector& x, const Vector& c);

/// ||x - W⁻¹c||_W = ||Wx - c||_(W⁻¹): what the rounding of x costs where W⁻¹c is meant. In a metric that is
/// nearly singular no double may be nearer.
double miss_of_solve(const Metric& W, const Vector& x, const Vector& c);

/// W as a full matrix.
Matrix gram(const Metric& W);

/// How stiff W is: its eigenvalues' ends (estimated by power iterations, from inside) and, per entry,
/// w_ii and (W⁻¹)_ii.
struct MetricScales {
  double smallest = 1, largest = 1;
  Vector diagonal, inverse_diagonal;
  /// A number between the ends: in a metric of this times the identity, a prox that is rounded costs x and v
  /// equally much in the norms of W and W⁻¹, sqrt(condition) roundings.
  double middle() const;
  /// The same by entries: sqrt(w_ii / (W⁻¹)_ii).
  Vector middle_by_entry() const;
  /// Upper bounds of ||e||_W and ||e||_(W⁻¹) over all e with these absolute values; `scattered`: the values
  /// are known as a whole, |e|₂, and not by entries.
  double norm_of_size(const Vector& size, bool scattered) const;
  double dual_norm_of_size(const Vector& size, bool scattered) const;
};

MetricScales metric_scales(const Metric& W);

}  // namespace convex::inline composite
