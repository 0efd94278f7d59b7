#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mechanics/liquid/liquid_scene.hpp"

namespace mechanics::liquid {

/// The pressure of a liquid and what follows from it.
struct LiquidSolution {
  enum class Status {
    solved,
    inaccurate,  ///< the error asked for is not met
    infeasible   ///< without a free surface, walls and h squeeze the liquid
  };
  Status status = Status::solved;
  std::string method;  ///< "line", "radial" or "grid"
  convex::Index unknowns = 0, cells = 0;
  double surplus = 0;  ///< ∫ h + ∫ ρ (F·n - a) where there is no free part; infeasible above 0
  double volume = 0;   ///< of the domain
  double cavity_measure = 0;
  std::optional<std::pair<Point, Point>> cavity_extent;
  double largest = 0;  ///< p, over the closed domain
  Point largest_at{};
  std::vector<std::string> parted_walls;
  /// Parts that say where they are and have no point of the boundary.
  std::vector<std::string> empty_parts;
  bool is_proved = false;  ///< `error_bound` is
  std::string unproved;    ///< what stands in the way of a proof that was asked for
  double error_bound = 0;  ///< of |p - p*| in the largest norm, the discretisation included
  /// A proved bound of |p - p_h| at all nodes and walls of the grid, p_h the solution of the grid's equations
  /// as their doubles say: it tells nothing of the discretisation.
  std::optional<double> grid_bound;
  /// In the closed domain; NaN where it is so thin that no node of the grid is near.
  std::function<double(const Point&)> p;
  std::function<bool(const Point&)> in_cavity;  ///< p = 0 and the liquid parts
};

/// `tolerance`: of max p, 1e-3 by default; beyond it the status is `inaccurate`, also where the file says how
/// many cells.
struct LiquidAccuracy {
  std::optional<double> tolerance;
  /// The bound is to be proved: p between a sub- and a supersolution, for the scene as it is written; on
  /// grids that of their equations.
  bool proved = false;
  double part() const { return tolerance.value_or(1e-3); }
};

/// The least pressure. A scene in one dimension, or radial, by ordinary differential equations; others on
/// grids. Throws InvalidInput for a velocity with divergence in the liquid, a negative pressure given, a
/// boundary point without a part.
LiquidSolution solve_liquid(const LiquidScene&, const LiquidAccuracy& = {});

/// p at a point as it is probed: with d(div u)/dt, 0 outside of the cavity. Throws InvalidInput for a point
/// outside of the domain.
struct LiquidProbe {
  Point at{};
  double p = 0, growth = 0;
};
LiquidProbe probe(const LiquidScene&, const LiquidSolution&, const Point&);

}  // namespace mechanics::liquid
