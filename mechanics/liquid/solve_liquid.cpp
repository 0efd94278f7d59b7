#include <algorithm>
#include <cmath>

#include "convex/invalid_input.hpp"
#include "mechanics/liquid/continuity.hpp"
#include "mechanics/liquid/grid_scene.hpp"
#include "mechanics/liquid/line_scene.hpp"
#include "mechanics/liquid/liquid_solution.hpp"
#include "mechanics/liquid/proved_line.hpp"
#include "mechanics/liquid/proved_zero.hpp"

namespace mechanics::liquid {
namespace {

/// Asks for div u = 0 where the liquid is, at points all over a scene of one variable.
void require_no_divergence(const LiquidScene& scene, const LineScene& line, const LiquidSolution& found) {
  constexpr int points = 200;
  const Point direction = scene.dimension() == 3 ? Point{0.48, 0.6, 0.64} : Point{0.6, 0.8, 0};
  for (int k = 0; k < points; ++k) {
    const double r = line.problem.low + (line.problem.high - line.problem.low) * (k + 0.5) / points;
    Point x = line.at(r);
    if (line.radial)
      for (std::size_t i = 0; i < scene.dimension(); ++i) x[i] = line.centre[i] + r * direction[i];
    if (!found.in_cavity(x)) scene.require_no_divergence(x);
  }
}

/// Where p = 0 was found everywhere: the proof that it is so.
void prove_zero(const LiquidScene& scene, LiquidSolution& found) {
  if (found.is_proved || found.status == LiquidSolution::Status::infeasible || found.largest > 0 ||
      !is_proved_zero(scene))
    return;
  found.is_proved = true;
  found.error_bound = 0;
  found.status = LiquidSolution::Status::solved;
}

LiquidSolution solve_scene(const LiquidScene& scene, const LiquidAccuracy& accuracy) {
  const std::optional<LineScene> line = as_line(scene);
  if (!line) {
    LiquidSolution found = solve_grid_scene(scene, accuracy);
    found.unproved = "on a grid nothing shows how far its equations are from the liquid";
    return found;
  }
  LiquidSolution found = solve_line_scene(scene, *line, accuracy);
  if (accuracy.proved && found.status != LiquidSolution::Status::infeasible)
    prove_line(scene, *line, accuracy, found);
  if (found.status != LiquidSolution::Status::infeasible) require_no_divergence(scene, *line, found);
  return found;
}

}  // namespace

LiquidSolution solve_liquid(const LiquidScene& scene, const LiquidAccuracy& accuracy) {
  require_continuous(scene);
  LiquidSolution found = solve_scene(scene, accuracy);
  if (accuracy.proved) prove_zero(scene, found);
  if (found.is_proved) found.unproved.clear();
  return found;
}

LiquidProbe probe(const LiquidScene& scene, const LiquidSolution& found, const Point& x) {
  if (scene.domain.level(x) > scene.domain.reach())
    throw convex::InvalidInput("--probe: " + point_text(scene.coordinates, x) +
                               " lies outside of the domain; give a point inside or on its boundary");
  const bool in_cavity = found.in_cavity(x);
  const double p = in_cavity ? 0 : found.p(x);
  if (std::isnan(p))
    throw convex::InvalidInput("--probe: at " + point_text(scene.coordinates, x) +
                               " the domain is thinner than the cells of the grid; give more cells");
  return {x, p, in_cavity ? scene.growth(x) : 0};
}

}  // namespace mechanics::liquid
