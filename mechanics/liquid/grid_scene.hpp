#pragma once

#include <memory>

#include "convex/obstacle_problem/cut_obstacle.hpp"
#include "mechanics/liquid/cut_cells.hpp"
#include "mechanics/liquid/liquid_solution.hpp"

namespace mechanics::liquid {

/// Nested grids: cells by axis of the coarsest, and how many times they are doubled.
struct GridNesting {
  std::array<convex::Index, 3> coarsest{1, 1, 1};
  long doublings = 0;
  std::array<convex::Index, 3> cells(long times) const;
};

/// Of about so many cells along the longest side; exactly so many where that can be halved often enough.
GridNesting nest_grids(const LiquidScene&, long cells);

/// How much of the cell around a node lies in the domain, to second order in the step.
double part_in_domain(const Domain&, const Point& node, const Point& step);

/// A scene on nested grids, each of twice as many cells a side as the next.
class GridLevels {
 public:
  GridLevels(const LiquidScene&, long cells);
  /// Twice as many cells.
  void refine();

  /// Throws InvalidInput, with the memory it would take, for a grid that does not fit.
  static void require_memory(const LiquidScene&, long cells);

  std::vector<convex::CutSolution> solve(bool one_sided) const;
  /// Without a free part, the sum of the loads on a grid and of their absolute values.
  std::pair<double, double> surplus(std::size_t level) const;
  /// A proved bound of |p - p_h| on the finest grid, infinite without one.
  double enclosed_error(const convex::CutSolution&) const;
  bool has_pull() const;
  /// Takes the surplus out of the loads, evenly over the volume.
  void balance();
  const CutCells& finest() const { return *levels_.front(); }
  /// The finest grid, which is no longer here.
  CutCells take_finest() { return std::move(*levels_.front()); }
  const CutCells& level(std::size_t l) const { return *levels_[l]; }
  std::size_t count() const { return levels_.size(); }
  long cells() const;

 private:
  std::vector<const convex::CutGrid*> grids() const;
  const LiquidScene& scene_;
  GridNesting nesting_;
  std::vector<std::unique_ptr<CutCells>> levels_;
};

LiquidSolution solve_grid_scene(const LiquidScene&, const LiquidAccuracy&);

/// The least value of the pressure without the obstacle on a grid; where no pressure is given, the sum of the
/// loads, which is below 0 if and only if the walls lack liquid.
double least_grid_pressure(const LiquidScene&, long cells);

}  // namespace mechanics::liquid
