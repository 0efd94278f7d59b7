#include "mechanics/liquid/sample.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics::liquid {

Point LiquidSample::at(std::size_t k) const {
  auto rest = static_cast<long>(k);
  Point x{};
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = low[i] + step[i] * static_cast<double>(rest % points[i]);
    rest /= points[i];
  }
  return x;
}

long sample_cells(const LiquidScene& scene) {
  const std::array<long, 3> default_cells{1000, 200, 48};
  return scene.cells.value_or(default_cells[scene.dimension() - 1]);
}

LiquidSample sample(const LiquidScene& scene, const LiquidSolution& found, long cells) {
  LiquidSample made;
  const Domain& domain = scene.domain;
  const double cell = domain.longest() / static_cast<double>(cells);
  made.low = domain.low;
  std::size_t count = 1;
  for (std::size_t i = 0; i < scene.dimension(); ++i) {
    const double side = domain.high[i] - domain.low[i];
    made.points[i] = std::max(1L, std::lround(side / cell)) + 1;
    made.step[i] = side / static_cast<double>(made.points[i] - 1);
    count *= static_cast<std::size_t>(made.points[i]);
  }
  made.inside.resize(count);
  made.cavity.resize(count);
  made.p.resize(count);
  made.growth.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Point x = made.at(k);
    if (domain.level(x) > domain.reach()) continue;
    made.inside[k] = true;
    if (found.in_cavity(x)) {
      made.cavity[k] = true;
      made.growth[k] = scene.growth(x);
      continue;
    }
    const double p = found.p(x);
    made.inside[k] = !std::isnan(p);
    if (made.inside[k]) made.p[k] = std::max(0.0, p);
  }
  return made;
}

}  // namespace mechanics::liquid
