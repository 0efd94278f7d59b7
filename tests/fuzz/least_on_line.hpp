#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace fuzz {

template <class F>
LineMinimum least_on_line(const F& f, const std::vector<Real>& seeds) {
  constexpr int decades = 24, sections = 90;
  std::vector<Real> grid{0};
  for (int k = -decades; k <= decades; k += 2)
    for (const Real sign : {-1.0L, 1.0L}) grid.push_back(sign * std::pow(10.0L, static_cast<Real>(k) / 1.5L));
  for (const Real seed : seeds)
    for (const Real step : {0.0L, 1e-9L, -1e-9L, 1e-3L, -1e-3L, 1.0L, -1.0L}) grid.push_back(seed + step);
  std::sort(grid.begin(), grid.end());
  grid.erase(std::unique(grid.begin(), grid.end()), grid.end());
  std::size_t best = 0;
  std::vector<Real> values;
  for (const Real t : grid) values.push_back(f(t));
  for (std::size_t i = 1; i < grid.size(); ++i)
    if (values[i] < values[best] || std::isnan(values[best])) best = i;
  LineMinimum found{grid[best], values[best]};
  if (!(found.value < std::numeric_limits<Real>::infinity())) return found;
  Real low = grid[best > 0 ? best - 1 : 0], high = grid[std::min(best + 1, grid.size() - 1)];
  constexpr Real golden = 0.381966011250105152L;
  Real a = low + golden * (high - low), b = high - golden * (high - low);
  Real at_a = f(a), at_b = f(b);
  for (int k = 0; k < sections; ++k) {
    // Outside the domain the sides compare by distance: the point where the least value was found is inside.
    const bool left = at_a == at_b ? (a + b) / 2 > found.at : at_a < at_b;
    if (left) {
      high = b;
      b = a;
      at_b = at_a;
      a = low + golden * (high - low);
      at_a = f(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = high - golden * (high - low);
      at_b = f(b);
    }
    if (at_a < found.value) found = {a, at_a};
    if (at_b < found.value) found = {b, at_b};
  }
  return found;
}

}  // namespace fuzz
