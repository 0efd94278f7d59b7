#pragma once

#include <vector>

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::linear_quadratic {

/// The point that a set of active rows defines, to twice the working precision where that converges.
struct PolishedPoint {
  bool converged = false;
  Vector xi, lambda;   ///< rounded once: n + k; m
  Vector v;            ///< the subgradient of f at x that they give: n
  double missing = 0;  ///< an estimate of ||x - x*||_W, x* the exact point of these rows, rounding included
                       ///< (of ξ when n = 0)
};

/// Solves Hξ + c + W(x - z) = G_Bᵀlambda, G_B ξ = h_B for independent rows B, starting from (xi, lambda), by
/// corrections with the factor of `round`, the same rows under H + W + softness: residuals are those of the
/// data in twice the working precision, and each correction leaves about the part that softness has in the
/// curvature (Wilkinson 1963, the factor being that of a neighbour). scale: what corrections of x, or of ξ
/// when n = 0, are to become small against. Not converged when they do not, or when a multiplier changes its
/// sign beyond rounding.
PolishedPoint polish(const LinearQuadratic& f, const Metric& W, const Vector& z,
                     const NearestPointProblem& round, const std::vector<Index>& rows, const Vector& xi,
                     const Vector& lambda, double scale);

}  // namespace convex::linear_quadratic
