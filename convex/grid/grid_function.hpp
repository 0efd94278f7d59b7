#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::inline grids {

/// A function known by its values on a rectangular grid of one to three dimensions and taken as +inf off it.
struct GridFunction {
  std::vector<Vector> axes;  ///< the coordinates along each dimension, strictly increasing
  Vector values;             ///< +inf allowed; the first dimension runs fastest

  double operator()(Index i, Index j = 0, Index k = 0) const {
    const Index n = axes[0].size(), m = axes.size() > 1 ? axes[1].size() : 1;
    return values[i + n * (j + m * k)];
  }
};

/// Throws InvalidInput "where: …" on a number of dimensions other than 1 to 3, an axis that is empty, not
/// finite or not strictly increasing, values that do not match the axes in number, a NaN or -inf, and +inf
/// everywhere.
void validate(const GridFunction&, const char* where);
/// The same of the axes alone.
void validate_axes(const std::vector<Vector>& axes, const char* where);

/// The values of f, a function of a Vector, on the grid.
template <class F>
GridFunction sample(const F& f, const std::vector<Vector>& axes) {
  validate_axes(axes, "sample");
  const Index dimension = static_cast<Index>(axes.size());
  Index count = 1;
  for (const Vector& axis : axes) count *= axis.size();
  GridFunction sampled{axes, Vector(count)};
  Vector x(dimension);
  for (Index point = 0; point < count; ++point) {
    Index rest = point;
    for (Index k = 0; k < dimension; ++k) {
      const Vector& axis = axes[static_cast<std::size_t>(k)];
      x[k] = axis[rest % axis.size()];
      rest /= axis.size();
    }
    sampled.values[point] = f(x);
  }
  return sampled;
}

}  // namespace convex::inline grids
