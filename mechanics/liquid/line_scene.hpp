#pragma once

#include <optional>

#include "convex/obstacle_problem/line_obstacle.hpp"
#include "mechanics/liquid/first_change.hpp"
#include "mechanics/liquid/liquid_solution.hpp"

namespace mechanics::liquid {

/// A scene that one variable describes: the coordinate, or the distance from a centre.
struct LineScene {
  convex::LineObstacle problem;
  bool radial = false;
  Point centre{};
  const BoundaryPart *low = nullptr, *high = nullptr;  ///< what holds at the ends; null at a centre

  /// The point at a value of the variable.
  Point at(double r) const;
  double variable(const Point&) const;
};

/// None when the scene is neither of one dimension nor radial. It is radial when its domain is a ball or a
/// shell, and h, the conditions of the parts and what they give are seen from the text to depend on the
/// distance alone (CoordinateForm). Said radial and not so: InvalidInput. The LineScene refers to the scene.
std::optional<LineScene> as_line(const LiquidScene&);

LiquidSolution solve_line_scene(const LiquidScene&, const LineScene&, const LiquidAccuracy&);

/// The least value of the pressure without the obstacle, below 0 if and only if cavitation has begun; where
/// no pressure is given, minus what the walls lack. With its error, 0 where that is not known; infinite where
/// more than the cells allowed would have been needed, and no departures say what that makes.
RoundedValue least_line_pressure(const convex::LineObstacle&);

}  // namespace mechanics::liquid
