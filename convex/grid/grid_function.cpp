#include "convex/grid/grid_function.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"

namespace convex::inline grids {
namespace {

void require(bool holds, const char* where, const std::string& what) {
  if (!holds) throw InvalidInput(std::string(where) + ": " + what);
}

}  // namespace

void validate_axes(const std::vector<Vector>& axes, const char* where) {
  require(axes.size() >= 1 && axes.size() <= 3, where,
          "the grid has " + std::to_string(axes.size()) + " dimensions; give one to three axes");
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const Vector& axis = axes[k];
    const std::string name = "axis " + std::to_string(k);
    require(axis.size() > 0, where, name + " is empty; give at least one coordinate");
    require(axis.allFinite(), where, name + " is not finite; give finite coordinates");
    for (Index i = 1; i < axis.size(); ++i)
      require(axis[i - 1] < axis[i], where,
              name + " does not increase at entry " + std::to_string(i) + "; sort it, each coordinate once");
  }
}

void validate(const GridFunction& f, const char* where) {
  validate_axes(f.axes, where);
  Index count = 1;
  for (const Vector& axis : f.axes) count *= axis.size();
  require(f.values.size() == count, where,
          "there are " + counted(f.values.size(), "value", "values") + " on a grid of " +
              counted(count, "point", "points") + "; give one for each point");
  bool proper = false;
  for (Index i = 0; i < count; ++i) {
    require(f.values[i] > -std::numeric_limits<double>::infinity(), where,
            "value " + std::to_string(i) + " is NaN or -inf; give numbers or +inf");
    proper = proper || std::isfinite(f.values[i]);
  }
  require(proper, where, "every value is +inf, the function is improper; make one finite");
}

}  // namespace convex::inline grids
