#include "mechanics/liquid/line_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"

namespace mechanics::liquid {
namespace {

using convex::InvalidInput;
using convex::LineEnd;
using convex::LineSolution;

Point moved(const Point& from, const Point& n, double by) {
  return {from[0] + by * n[0], from[1] + by * n[1], from[2] + by * n[2]};
}

bool is_radial(const Field& field, const LineScene& line) {
  return field.is_constant() || field.form().is_radial(line.centre);
}

/// The radii between which the level of an inequality domain is below 0 along an axis, if it is one interval.
bool find_radii(const Domain& domain, LineScene& line) {
  constexpr int samples = 4000;
  double end = 0;
  for (std::size_t i = 0; i < domain.dimension; ++i)
    end = std::max({end, domain.high[i] - line.centre[i], line.centre[i] - domain.low[i]});
  const auto level = [&](double r) { return domain.level(line.at(r)); };
  std::vector<double> ends;
  bool inside = level(0) < 0;
  if (inside) ends.push_back(0);
  for (int k = 0; k < samples; ++k) {
    double a = end * k / samples, b = end * (k + 1) / samples;
    if ((level(b) < 0) == inside) continue;
    for (int halving = 0; halving < 80; ++halving) {
      const double middle = 0.5 * (a + b);
      ((level(middle) < 0) == inside ? a : b) = middle;
    }
    inside = !inside;
    ends.push_back(inside ? b : a);
  }
  if (ends.size() != 2) return false;
  line.problem.low = ends[0];
  line.problem.high = ends[1];
  return true;
}

bool find_shell(const LiquidScene& scene, LineScene& line) {
  const Domain& domain = scene.domain;
  if (domain.shape == Domain::Shape::ball) {
    line.centre = domain.centre;
    line.problem.high = domain.radius;
    return true;
  }
  if (domain.shape != Domain::Shape::inequalities) return false;
  const std::vector<const Field*> fields = domain.condition->fields();
  if (fields.empty() || fields.front()->is_constant()) return false;
  const std::optional<Point> middle = fields.front()->form().middle();
  if (!middle) return false;
  line.centre = *middle;
  for (const Field* field : fields)
    if (!is_radial(*field, line)) return false;
  return find_radii(domain, line);
}

LineEnd line_end(const LiquidScene& scene, const BoundaryPart& part, const Point& x, const Point& n) {
  if (part.is_free) return {LineEnd::Kind::value, scene.free_pressure(part, x)};
  return {LineEnd::Kind::flux, scene.wall_flux(part, x, n)};
}

/// Fills in what holds at a sphere, if it is one thing.
bool find_sphere(const LiquidScene& scene, LineScene& line, bool is_low) {
  const double r = is_low ? line.problem.low : line.problem.high, side = is_low ? -1 : 1;
  const Point n{1, 0, 0}, x = moved(line.centre, n, r);
  for (const BoundaryPart& part : scene.parts) {
    for (const Field* field : part.where.fields())
      if (!is_radial(*field, line)) return false;
    if (part.where.holds(x, scene.domain.reach())) break;
  }
  const BoundaryPart& part = scene.boundary_part(x);
  if (!is_radial(part.value, line)) return false;
  if (!part.is_free) {
    std::vector<const CoordinateForm*> force;
    for (const Field& along : scene.force) force.push_back(&along.form());
    if (!CoordinateForm::is_radial_along(force, line.centre)) return false;
  }
  (is_low ? line.low : line.high) = &part;
  (is_low ? line.problem.at_low : line.problem.at_high) = line_end(scene, part, x, {side, 0, 0});
  return true;
}

bool find_radial(const LiquidScene& scene, LineScene& line) {
  line.radial = true;
  line.problem.power = static_cast<int>(scene.dimension()) - 1;
  if (!find_shell(scene, line) || !is_radial(scene.h, line)) return false;
  if (line.problem.low > 0) {
    if (!find_sphere(scene, line, true)) return false;
  } else {
    line.problem.at_low.kind = LineEnd::Kind::centre;
  }
  return find_sphere(scene, line, false);
}

LineScene interval(const LiquidScene& scene) {
  const Domain& domain = scene.domain;
  LineScene line;
  line.problem.low = domain.low[0];
  line.problem.high = domain.high[0];
  if (domain.shape == Domain::Shape::ball) {
    line.problem.low = domain.centre[0] - domain.radius;
    line.problem.high = domain.centre[0] + domain.radius;
  }
  if (domain.shape == Domain::Shape::inequalities) {
    constexpr int samples = 4096;
    std::vector<double> ends;
    double before = domain.low[0];
    bool inside = domain.level({before, 0, 0}) <= 0;
    if (inside) ends.push_back(before);
    for (int k = 1; k <= samples; ++k) {
      const double x = domain.low[0] + (domain.high[0] - domain.low[0]) * k / samples;
      const bool now = domain.level({x, 0, 0}) <= 0;
      if (now != inside)
        ends.push_back(now ? domain.crossing({x, 0, 0}, {before, 0, 0})[0]
                           : domain.crossing({before, 0, 0}, {x, 0, 0})[0]);
      inside = now;
      before = x;
    }
    if (inside) ends.push_back(before);
    if (ends.size() > 2)
      throw InvalidInput("domain: it is not connected; give one interval, and the others files of their own");
    if (ends.size() < 2) throw InvalidInput("domain: it is empty between low and high; give one that is not");
    line.problem.low = ends[0];
    line.problem.high = ends[1];
  }
  const Point low{line.problem.low, 0, 0}, high{line.problem.high, 0, 0};
  line.low = &scene.boundary_part(low);
  line.high = &scene.boundary_part(high);
  line.problem.at_low = line_end(scene, *line.low, low, {-1, 0, 0});
  line.problem.at_high = line_end(scene, *line.high, high, {1, 0, 0});
  return line;
}

double content(const LineScene& line, std::size_t dimension, double low, double high) {
  using std::numbers::pi;
  if (dimension == 1 || !line.radial) return high - low;
  return dimension == 2 ? pi * (high - low) * (high + low)
                        : 4 * pi / 3 * (high * high * high - low * low * low);
}

/// The cavity's measure and extent.
void measure(LiquidSolution& found, const LineScene& line, const LineSolution& solution, std::size_t d) {
  bool is_first = true;
  double low = 0, high = 0;
  for (const convex::LinePiece& piece : solution.pieces()) {
    if (piece.positive) continue;
    found.cavity_measure += content(line, d, piece.low, piece.high);
    if (is_first) low = piece.low;
    high = piece.high;
    is_first = false;
  }
  if (is_first) return;
  found.cavity_extent.emplace();
  for (std::size_t i = 0; i < d; ++i) {
    found.cavity_extent->first[i] = line.radial ? line.centre[i] - high : low;
    found.cavity_extent->second[i] = line.radial ? line.centre[i] + high : high;
  }
}

}  // namespace

Point LineScene::at(double r) const { return radial ? moved(centre, {1, 0, 0}, r) : Point{r, 0, 0}; }

double LineScene::variable(const Point& x) const {
  const double r = radial ? std::hypot(x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]) : x[0];
  return std::clamp(r, problem.low, problem.high);
}

std::optional<LineScene> as_line(const LiquidScene& scene) {
  LineScene line;
  if (scene.dimension() == 1) {
    line = interval(scene);
  } else if (!find_radial(scene, line)) {
    if (scene.radial)
      throw InvalidInput(
          "symmetry = \"radial\": the scene is not; the domain must be a disc, ball or shell, and h, the "
          "parts and "
          "what they give the same in all directions; take symmetry out");
    return std::nullopt;
  }
  line.problem.h = [&scene, line](double r) { return scene.h(line.at(r)); };
  if (scene.bound == Bound::none && !scene.h.is_constant()) {
    Ray from{};
    if (line.radial) std::copy(line.centre.begin(), line.centre.end(), from.begin());
    line.problem.departure = [&scene, from](double a, double b) { return scene.h.departure(from, a, b); };
    if (!line.radial)
      line.problem.mass = [&scene](double a, double b) {
        const expression::Range load = scene.load_range({a, b});
        return std::max(-load.low, load.high);
      };
  }
  return line;
}

LiquidSolution solve_line_scene(const LiquidScene& scene, const LineScene& line,
                                const LiquidAccuracy& accuracy) {
  const std::size_t d = scene.dimension();
  LiquidSolution found;
  found.method = line.radial ? "radial" : "line";
  found.volume = content(line, d, line.problem.low, line.problem.high);
  const LineSolution solution = convex::solve_line(line.problem);
  found.unknowns = solution.nodes;
  found.cells = solution.nodes - 1;
  found.surplus = solution.surplus;
  if (solution.status == LineSolution::Status::infeasible) {
    found.status = LiquidSolution::Status::infeasible;
    found.unknowns = 1;
    return found;
  }
  measure(found, line, solution, d);
  const LineSolution::Extreme largest = solution.largest();
  found.largest = largest.value;
  found.largest_at = line.at(largest.at);
  // Where ρ (F·n - a) is 0 to rounding nothing says that the liquid leaves.
  const auto leaves = [&](const BoundaryPart& wall, double r, double side) {
    const Point x = line.at(r);
    return scene.wall_flux_range(wall, {{{x[0], x[0]}, {x[1], x[1]}, {x[2], x[2]}}}, {side, 0, 0}).high < 0;
  };
  const bool low_parts = solution.low_parts && leaves(*line.low, line.problem.low, -1),
             high_parts = solution.high_parts && leaves(*line.high, line.problem.high, 1);
  if (low_parts) found.parted_walls.push_back(line.low->name);
  if (high_parts && !(low_parts && line.low == line.high)) found.parted_walls.push_back(line.high->name);
  for (const BoundaryPart& part : scene.parts)
    if (&part != line.low && &part != line.high && !part.where.is_always())
      found.empty_parts.push_back(part.name);
  found.error_bound = solution.error_bound;
  // Where all is cavity there is no pressure that the bound could be a part of, but what would make one.
  const double size = found.largest > 0 ? found.largest : scene.pressure_scale();
  if (!(found.error_bound <= accuracy.part() * size) && found.error_bound > 0)
    found.status = LiquidSolution::Status::inaccurate;
  found.p = [line, solution](const Point& x) { return solution.p(line.variable(x)); };
  found.in_cavity = [line, pieces = solution.pieces()](const Point& x) {
    const double r = line.variable(x);
    return std::any_of(pieces.begin(), pieces.end(), [&](const convex::LinePiece& piece) {
      return !piece.positive && piece.low <= r && r <= piece.high;
    });
  };
  return found;
}

RoundedValue least_line_pressure(const convex::LineObstacle& line) {
  const LineSolution solution = convex::solve_line(line, false);
  const bool is_closed =
      line.at_low.kind != LineEnd::Kind::value && line.at_high.kind != LineEnd::Kind::value;
  const double least = is_closed ? solution.surplus : solution.least().value;
  if (solution.nodes > line.most_cells && !line.departure) return {least, convex::infinity};
  return {least, std::isfinite(solution.error_bound) ? solution.error_bound : 0};
}

}  // namespace mechanics::liquid
