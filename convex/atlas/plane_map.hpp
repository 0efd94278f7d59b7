#pragma once

#include <array>

#include "convex/atlas/atlas.hpp"

namespace convex::atlas {

/// z = origin + Σ p_k direction_k for the parameters p_k in [low_k, high_k], one or two of them.
struct Parameters {
  ExactVector origin;
  std::vector<ExactVector> directions;
  std::vector<Fraction> low, high;
};

/// A convex polygon in the plane of two parameters, counter-clockwise; of one, an interval.
using ParameterPoint = std::vector<Fraction>;
struct ParameterPolygon {
  std::vector<ParameterPoint> corners;
  Fraction area;  ///< of an interval, its length
};

/// What a cell has of the plane, and of that the part where the rule of dropping negative multipliers is
/// right; the whole of it on the cell of all rows, none where the rule is not defined.
struct PlaneRegion {
  std::size_t cell = 0;
  ParameterPolygon polygon;
  std::optional<ParameterPolygon> right;
};

/// The regions with interior, in the order of their cells, exactly: they fill the rectangle.
std::vector<PlaneRegion> plane_map(const Atlas&, const Parameters&);

}  // namespace convex::atlas
