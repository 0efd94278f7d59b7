#pragma once

#include <random>

#include "convex/obstacle_problem/cut_grid.hpp"

namespace tests {

/// A grid with holes, random links and loads, and pendants; the frame of its points gives values.
inline convex::CutGrid random_grid(std::size_t dimension, convex::Index points, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::array<convex::Index, 3> n{1, 1, 1};
  for (std::size_t i = 0; i < dimension; ++i) n[i] = points;
  convex::CutGrid grid(dimension, n);
  for (convex::Index c = 0; c < n[2]; ++c)
    for (convex::Index b = 0; b < n[1]; ++b)
      for (convex::Index a = 0; a < n[0]; ++a) {
        const auto k = static_cast<std::size_t>(grid.at(a, b, c));
        const double kind = unit(random);
        grid.kind[k] = kind < 0.05  ? convex::CutPoint::beyond
                       : kind < 0.1 ? convex::CutPoint::free
                                    : convex::CutPoint::bounded;
      }
  for (convex::Index k = 0; k < grid.size(); ++k) {
    if (!grid.is_unknown(k)) continue;
    const auto i = static_cast<std::size_t>(k);
    for (std::size_t axis = 0; axis < dimension; ++axis)
      if (grid.is_unknown(k + grid.stride(axis))) grid.link[axis][i] = 0.5 + unit(random);
    if (unit(random) < 0.05) grid.pull[i] = 1 + unit(random);
    grid.load[i] = 0.2 * (unit(random) - 0.55);
    if (unit(random) < 0.05) grid.pendants.push_back({k, 2 * unit(random), 0.1 * (unit(random) - 0.5)});
  }
  for (convex::Index k = 0; k < grid.size(); ++k)  // what hangs on nothing is held a little
    if (grid.is_unknown(k)) grid.pull[static_cast<std::size_t>(k)] += 1e-3;
  return grid;
}

}  // namespace tests
