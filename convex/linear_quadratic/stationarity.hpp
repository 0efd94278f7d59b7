#pragma once

#include "convex/double_double.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/metric.hpp"

namespace convex::linear_quadratic {

/// sum += A x in twice the working precision.
void add_product(const Metric& A, const DoubleDoubleVector& x, DoubleDoubleVector& sum);

/// Hξ + c in twice the working precision: n + k.
DoubleDoubleVector slope(const LinearQuadratic& f, const DoubleDoubleVector& xi);

/// Hξ + c + W(x - z), W acting on the first n entries, in twice the working precision: n + k.
DoubleDoubleVector gradient(const LinearQuadratic& f, const Metric& W, const Vector& z,
                            const DoubleDoubleVector& xi);

/// That minus Gᵀlambda, rounded once: 0 at the solution.
Vector stationarity_defect(const LinearQuadratic& f, const Metric& W, const Vector& z, const Vector& xi,
                           const Vector& lambda);

/// (Hξ + c - Gᵀlambda) on the first n entries, rounded once: the subgradient of f at x that the multipliers
/// give (Rockafellar and Wets 1998, theorem 10.13).
Vector subgradient_of_multipliers(const LinearQuadratic& f, const Vector& xi, const Vector& lambda);

/// lambda·(Gξ - h): what is missing in f(x) + f*(v) = x·v beside the defect of stationarity.
double complementarity(const LinearQuadratic& f, const Vector& xi, const Vector& lambda);

/// What the terms of entry j of the defect without W add up to in size; its rounding is relative to this.
Vector defect_terms(const LinearQuadratic& f, const Vector& xi, const Vector& lambda);

/// ||e_i||_(W⁻¹) for every entry i: how far x may move in ||·||_W per unit of that entry of its covector. In
/// a metric that is nearly singular a rounding of the covector is far.
Vector softness_of_entries(const Metric& W);

}  // namespace convex::linear_quadratic
