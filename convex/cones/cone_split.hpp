#pragma once

#include "convex/cones/cone_faces.hpp"
#include "convex/cones/exact_metric.hpp"

namespace convex::inline cones {

/// proj_K z, the point of K nearest to z in the metric, as a fraction: Lawson and Hanson's method (1974,
/// chapter 23) over the generators and lines of K in exact arithmetic, which is finite without any tolerance.
ExactVector proj(const PolyhedralCone& K, const ExactVector& z, const ExactMetric& W);

/// The same for doubles at their exact values, rounded once.
Vector proj(const PolyhedralCone& K, const Vector& z, const Metric& W);

/// z = x + y with x in K, y in K°, (x|y) = 0 (Moreau 1962): x by the generators of K, y by those of K°.
struct ConeSplit {
  ExactVector x, y;
  ConeFace face;        ///< of K, with x in its relative interior
  ConeFace polar_face;  ///< of K°, with y in its relative interior
  Fraction inner;       ///< (x|y)
  double residual = 0;  ///< ||z - x - y||_W
};

/// `polar_cone` is polar(K, W); InvalidInput where the two points do not make up z, as those of polar cones
/// do.
ConeSplit split(const PolyhedralCone& K, const PolyhedralCone& polar_cone, const ExactVector& z,
                const ExactMetric& W);

}  // namespace convex::inline cones
