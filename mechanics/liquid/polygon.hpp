#pragma once

#include <array>
#include <functional>
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

/// The point of the boundary nearest to x.
Vertex polygon_foot(const std::vector<Vertex>&, const Vertex& x);

}  // namespace mechanics::liquid
