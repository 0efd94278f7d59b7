#pragma once

#include <array>
#include <vector>

#include "mechanics/liquid/liquid_solution.hpp"

namespace mechanics::liquid {

/// A solution at the points of a regular grid over the box of the domain, the first coordinate fastest.
struct LiquidSample {
  std::array<long, 3> points{1, 1, 1};
  Point low{}, step{};
  std::vector<bool> inside;  ///< in the closed domain; elsewhere the rest is 0
  std::vector<double> p, growth;
  std::vector<bool> cavity;

  Point at(std::size_t k) const;
};

/// `cells` along the longest side.
LiquidSample sample(const LiquidScene&, const LiquidSolution&, long cells);

/// As many as the file says, or a default that makes pictures and tables of reasonable size.
long sample_cells(const LiquidScene&);

}  // namespace mechanics::liquid
