#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "convex/invalid_input.hpp"
#include "convex/obstacle_problem/cut_enclosure.hpp"
#include "mechanics/liquid/grid_scene.hpp"

namespace mechanics::liquid {

using convex::Index;

namespace {

/// What a node takes: links, loads, signs, and the fields of the solver, on all grids.
double bytes_of_a_node(std::size_t dimension) { return 130 + 16 * static_cast<double>(dimension); }

double nodes(const LiquidScene& scene, long cells) {
  double count = 1;
  for (std::size_t i = 0; i < scene.dimension(); ++i)
    count *= 1 + static_cast<double>(cells) * (scene.domain.high[i] - scene.domain.low[i]) /
                     scene.domain.longest();
  return count;
}

}  // namespace

void GridLevels::require_memory(const LiquidScene& scene, long cells) {
  const double count = nodes(scene, cells), bytes = count * bytes_of_a_node(scene.dimension());
  const double available =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  constexpr double most_nodes = 5e8;
  if (bytes <= 0.8 * available && count <= most_nodes) return;
  char numbers[160];
  std::snprintf(
      numbers, sizeof numbers,
      "cells = %ld makes a grid of %.3g points, which would take %.3g GB of memory; this computer has %.3g",
      cells, count, bytes * 1e-9, available * 1e-9);
  throw convex::InvalidInput(std::string(numbers) + "; give fewer cells, or leave them out");
}

std::array<Index, 3> GridNesting::cells(long times) const {
  std::array<Index, 3> n{1, 1, 1};
  for (std::size_t i = 0; i < 3; ++i) n[i] = coarsest[i] << times;
  return n;
}

GridNesting nest_grids(const LiquidScene& scene, long cells) {
  double shortest = scene.domain.longest();
  for (std::size_t i = 0; i < scene.dimension(); ++i)
    shortest = std::min(shortest, scene.domain.high[i] - scene.domain.low[i]);
  // The coarsest grid has a cell or more across the shortest side and four or more along the longest.
  const double least = std::max(4.0, std::min(std::ceil(scene.domain.longest() / shortest), 64.0));
  constexpr long most = 40;  // beyond it, odd numbers of cells are rounded up
  GridNesting made;
  long coarsest = std::max(cells, static_cast<long>(least));
  while (coarsest % 2 == 0 && static_cast<double>(coarsest / 2) >= least) {
    coarsest /= 2;
    ++made.doublings;
  }
  while (coarsest > most && static_cast<double>(coarsest) >= 2 * least) {
    coarsest = (coarsest + 1) / 2;
    ++made.doublings;
  }
  for (std::size_t i = 0; i < scene.dimension(); ++i)
    made.coarsest[i] = std::max<Index>(
        1, std::lround(static_cast<double>(coarsest) * (scene.domain.high[i] - scene.domain.low[i]) /
                       scene.domain.longest()));
  return made;
}

GridLevels::GridLevels(const LiquidScene& scene, long cells)
    : scene_(scene), nesting_((require_memory(scene, cells), nest_grids(scene, cells))) {
  for (long k = 0; k <= nesting_.doublings; ++k) refine();
}

void GridLevels::refine() {
  const auto times = static_cast<long>(levels_.size());
  levels_.insert(levels_.begin(), std::make_unique<CutCells>(cut_cells(scene_, nesting_.cells(times))));
}

long GridLevels::cells() const {
  const auto& points = finest().grid.points;
  return std::max({points[0], points[1], points[2]}) - 1;
}

std::vector<const convex::CutGrid*> GridLevels::grids() const {
  std::vector<const convex::CutGrid*> grids;
  for (const auto& level : levels_) grids.push_back(&level->grid);
  return grids;
}

std::vector<convex::CutSolution> GridLevels::solve(bool one_sided) const {
  return convex::solve_cut_grids(grids(), one_sided);
}

double GridLevels::enclosed_error(const convex::CutSolution& found) const {
  return convex::enclosed_error(grids(), found);
}

bool GridLevels::has_pull() const {
  const std::vector<double>& pull = finest().grid.pull;
  return std::any_of(pull.begin(), pull.end(), [](double one) { return one > 0; });
}

std::pair<double, double> GridLevels::surplus(std::size_t l) const {
  double sum = 0, absolute = 0;
  const convex::CutGrid& grid = levels_[l]->grid;
  for (Index k = 0; k < grid.size(); ++k)
    if (grid.is_unknown(k)) {
      sum += grid.load[static_cast<std::size_t>(k)];
      absolute += std::abs(grid.load[static_cast<std::size_t>(k)]);
    }
  return {sum, absolute};
}

void GridLevels::balance() {
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    CutCells& cells = *levels_[l];
    const double sum = surplus(l).first;
    double volume = 0;
    for (std::size_t k = 0; k < cells.volume.size(); ++k)
      if (cells.grid.is_unknown(static_cast<Index>(k))) volume += cells.volume[k];
    for (std::size_t k = 0; k < cells.volume.size(); ++k)
      if (cells.grid.is_unknown(static_cast<Index>(k))) cells.grid.load[k] -= sum * cells.volume[k] / volume;
  }
}

}  // namespace mechanics::liquid
