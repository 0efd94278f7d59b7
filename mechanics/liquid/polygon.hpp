#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace mechanics::liquid {

using Vertex = std::array<double, 2>;

/// Turns the vertices counterclockwise and takes out repeated ones. "", or what is wrong with the polygon.
std::string arrange(std::vector<Vertex>&);

/// Half of the sum of cross products: the area, positive counterclockwise.
double polygon_area(const std::vector<Vertex>&);

/// The signed distance from the boundary, below 0 inside.
double polygon_level(const std::vector<Vertex>&, const Vertex&);

/// What of the polygon lies where a linear excess is <= 0 (Sutherland and Hodgman 1974; edges that only
/// join pieces run along the cut there and back, and bound no area).
std::vector<Vertex> cut_off(const std::vector<Vertex>&, const std::function<double(const Vertex&)>& excess);

/// A place where the boundary comes within `width` of itself though it is long from the one point to the
/// other along it: an eighth of the whole, as in a strip, or from a vertex four times their distance, as at
/// the mouth of a channel or a notch; and not at a corner or a short side. Sides are looked at in steps of
/// `width`.
std::optional<Vertex> narrow_place(const std::vector<Vertex>&, double width);

/// The point of the boundary nearest to x.
Vertex polygon_foot(const std::vector<Vertex>&, const Vertex& x);

}  // namespace mechanics::liquid
