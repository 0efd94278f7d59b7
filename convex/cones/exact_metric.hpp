#pragma once

#include "convex/exact/elimination.hpp"
#include "convex/exact/fraction.hpp"
#include "convex/metric.hpp"

namespace convex::inline cones {

/// A metric (x|y) = x·Wy in fractions: W = gram / denominator, gram⁻¹ = inverse.adjugate /
/// inverse.determinant.
struct ExactMetric {
  IntegerRows gram;
  Integer denominator = 1;
  ExactInverse inverse;
  Index dimension() const { return static_cast<Index>(gram.size()); }
};

/// Throws InvalidInput when W is not square or not symmetric (entries may differ by rounding, as in
/// Metric::dense).
void require_symmetric(const ExactRows& W);

ExactMetric identity_metric(Index n);

/// W by its rows. Throws InvalidInput when it is not square, not symmetric (entries may differ by rounding,
/// as in Metric::dense; their mean is then meant), or not positive definite.
ExactMetric exact_metric(const ExactRows& W);

/// The doubles of a metric at their exact values.
ExactMetric exact_metric(const Metric& W);

/// (x|y).
Fraction inner(const ExactMetric& W, const ExactVector& x, const ExactVector& y);

}  // namespace convex::inline cones
