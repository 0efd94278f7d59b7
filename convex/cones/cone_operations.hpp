#pragma once

#include "convex/cones/exact_metric.hpp"
#include "convex/cones/polyhedral_cone.hpp"

/// Operations on polyhedral cones, all exact. Sizes that do not fit throw InvalidInput.
namespace convex::inline cones {

/// K° = {y : (x|y) <= 0 for all x in K}, in the product of the metric. Its generators and lines are W⁻¹a and
/// W⁻¹e for the half-spaces a and the equations e of K; its half-spaces and equations, plain covectors, are
/// Wg and Wb for the generators g and the lines b of K.
PolyhedralCone polar(const PolyhedralCone& K, const ExactMetric& W);
/// In the plain product.
PolyhedralCone polar(const PolyhedralCone& K);

/// K* = -K°.
PolyhedralCone dual(const PolyhedralCone& K, const ExactMetric& W);

/// K_1 ∩ K_2.
PolyhedralCone intersection(const PolyhedralCone& first, const PolyhedralCone& second);
/// K_1 + K_2.
PolyhedralCone sum(const PolyhedralCone& first, const PolyhedralCone& second);
/// {Mx : x in K}; M by its rows, of K.n entries each.
PolyhedralCone image(const PolyhedralCone& K, const ExactRows& M);
/// {x : Mx in K}; M has K.n rows.
PolyhedralCone preimage(const PolyhedralCone& K, const ExactRows& M);

/// Whether x is in K, exactly: a double is the fraction that it stands for.
bool contains(const PolyhedralCone& K, const ExactVector& x);
bool contains(const PolyhedralCone& K, const Vector& x);
/// Whether the second is a part of the first.
bool includes(const PolyhedralCone& K, const PolyhedralCone& part);
bool are_equal(const PolyhedralCone& first, const PolyhedralCone& second);

}  // namespace convex::inline cones
