#include "convex/obstacle_problem/cut_grid.hpp"

#include <algorithm>

namespace convex::inline obstacle_problem {

CutGrid::CutGrid(std::size_t space, const std::array<Index, 3>& counts) : dimension(space), points(counts) {
  Index size = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    strides_[axis] = size;
    size *= points[axis] + 2 * frame(axis);
  }
  const auto n = static_cast<std::size_t>(size);
  kind.assign(n, CutPoint::beyond);
  for (std::size_t axis = 0; axis < dimension; ++axis) link[axis].assign(n, 0);
  pull.assign(n, 0);
  load.assign(n, 0);
}

Index CutGrid::unknowns() const {
  return std::count_if(kind.begin(), kind.end(), [](CutPoint point) { return point >= CutPoint::free; });
}

}  // namespace convex::inline obstacle_problem
