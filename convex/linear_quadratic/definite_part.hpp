#pragma once

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"

namespace convex::linear_quadratic {

/// The variables in which ½||x - z||_W² + f is not strictly convex by itself, and how strongly each should be
/// held near its last value.
struct SoftVariables {
  /// 0 where H + W is definite; else a curvature, the least that W can have in this variable through one row
  /// of G that ties it, directly or by way of others, to x: one step of the proximal-point method with a
  /// small part of it then gains many digits.
  Vector curvature;
  bool any = false;
  /// Whether there is any other curvature; without it only the ratio of curvatures matters.
  bool mixed = false;
};

SoftVariables soft_variables(const LinearQuadratic& f, const Metric& W);

/// H + W + diag(extra) as a metric on ξ. Throws InvalidInput when it is not positive definite to working
/// precision.
Metric curvature_metric(const LinearQuadratic& f, const Metric& W, const Vector& extra);

}  // namespace convex::linear_quadratic
