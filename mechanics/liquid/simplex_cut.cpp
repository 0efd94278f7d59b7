#include "mechanics/liquid/simplex_cut.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics::liquid {
namespace {

using Codes = std::array<unsigned, 4>;  // the corners of a simplex

Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double inner(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Calls simplex(codes, axes) for Kuhn's simplices over these axes: paths from `start` along the axes in
/// every order.
template <class Simplex>
void for_simplices(std::vector<std::size_t> axes, unsigned start, Simplex simplex) {
  do {
    Codes codes{start, start, start, start};
    for (std::size_t k = 0; k < axes.size(); ++k) codes[k + 1] = codes[k] | (1U << axes[k]);
    simplex(codes, axes);
  } while (std::next_permutation(axes.begin(), axes.end()));
}

/// The part of a simplex with these values at its corners where a linear function is below 0.
double negative_part(const std::array<double, 4>& value, std::size_t corners) {
  std::array<double, 4> v = value;
  std::sort(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(corners));
  std::size_t negative = 0;
  while (negative < corners && v[negative] < 0) ++negative;
  if (negative == 0) return 0;
  if (negative == corners) return 1;
  const auto tip = [&](std::size_t k) {  // what is cut off at the corner k, alone on its side
    double part = 1;
    for (std::size_t j = 0; j < corners; ++j)
      if (j != k) part *= v[k] / (v[k] - v[j]);
    return part;
  };
  if (negative == 1) return tip(0);
  if (negative + 1 == corners) return 1 - tip(corners - 1);
  // Two on each side of a tetrahedron: a wedge of three tetrahedra.
  const double ac = v[0] / (v[0] - v[2]), ad = v[0] / (v[0] - v[3]), bc = v[1] / (v[1] - v[2]),
               bd = v[1] / (v[1] - v[3]);
  return ac * ad + bc * bd + ac * bd - ac * ad * bd - ac * bc * bd;
}

Point corner(const CellLevels& cell, unsigned code) {
  Point x = cell.low;
  for (std::size_t i = 0; i < cell.dimension; ++i)
    if ((code >> i & 1U) != 0) x[i] += cell.step[i];
  return x;
}

std::vector<std::size_t> all_axes(std::size_t dimension) {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < dimension; ++i) axes.push_back(i);
  return axes;
}

double factorial(std::size_t n) { return n < 2 ? 1 : static_cast<double>(n) * factorial(n - 1); }

/// The surface in one simplex; its normal is that of the linear level.
SurfacePiece piece(const CellLevels& cell, const Codes& codes, const std::vector<std::size_t>& axes) {
  SurfacePiece made;
  const std::size_t corners = cell.dimension + 1;
  std::vector<unsigned> below, above;
  for (std::size_t k = 0; k < corners; ++k) (cell.at[codes[k]] < 0 ? below : above).push_back(codes[k]);
  if (below.empty() || above.empty()) return made;
  double square = 0;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double slope = (cell.at[codes[k + 1]] - cell.at[codes[k]]) / cell.step[axes[k]];
    made.normal[axes[k]] = slope;
    square += slope * slope;
  }
  for (double& entry : made.normal) entry /= std::sqrt(square);
  std::vector<Point> points;  // in order around the piece
  for (std::size_t a = 0; a < below.size(); ++a)
    for (std::size_t b = 0; b < above.size(); ++b) {
      const std::size_t turned = a % 2 == 0 ? b : above.size() - 1 - b;
      const double f = cell.at[below[a]], g = cell.at[above[turned]], part = f / (f - g);
      const Point low = corner(cell, below[a]), high = corner(cell, above[turned]);
      Point x{};
      for (std::size_t i = 0; i < 3; ++i) x[i] = low[i] + part * (high[i] - low[i]);
      points.push_back(x);
    }
  if (cell.dimension == 1) {
    made.area = 1;
    made.at = points.front();
    return made;
  }
  if (cell.dimension == 2) {
    const Point side = difference(points[1], points[0]);
    made.area = std::sqrt(inner(side, side));
    for (std::size_t i = 0; i < 3; ++i) made.at[i] = 0.5 * (points[0][i] + points[1][i]);
    return made;
  }
  for (std::size_t k = 1; k + 1 < points.size(); ++k) {
    const Point normal = cross(difference(points[k], points[0]), difference(points[k + 1], points[0]));
    const double area = 0.5 * std::sqrt(inner(normal, normal));
    for (std::size_t i = 0; i < 3; ++i)
      made.at[i] += area * (points[0][i] + points[k][i] + points[k + 1][i]) / 3;
    made.area += area;
  }
  if (made.area > 0)
    for (double& entry : made.at) entry /= made.area;
  return made;
}

}  // namespace

double CellLevels::fraction() const {
  double sum = 0;
  for_simplices(all_axes(dimension), 0, [&](const Codes& codes, const std::vector<std::size_t>&) {
    std::array<double, 4> value{};
    for (std::size_t k = 0; k <= dimension; ++k) value[k] = at[codes[k]];
    sum += negative_part(value, dimension + 1);
  });
  return sum / factorial(dimension);
}

double CellLevels::face_fraction(std::size_t axis, bool is_high) const {
  std::vector<std::size_t> axes;
  for (std::size_t i = 0; i < dimension; ++i)
    if (i != axis) axes.push_back(i);
  double sum = 0;
  for_simplices(axes, is_high ? 1U << axis : 0U, [&](const Codes& codes, const std::vector<std::size_t>&) {
    std::array<double, 4> value{};
    for (std::size_t k = 0; k < dimension; ++k) value[k] = at[codes[k]];
    sum += negative_part(value, dimension);
  });
  return sum / factorial(dimension - 1);
}

std::vector<SurfacePiece> CellLevels::surface() const {
  std::vector<SurfacePiece> found;
  for_simplices(all_axes(dimension), 0, [&](const Codes& codes, const std::vector<std::size_t>& axes) {
    const SurfacePiece one = piece(*this, codes, axes);
    if (one.area > 0) found.push_back(one);
  });
  return found;
}

}  // namespace mechanics::liquid
