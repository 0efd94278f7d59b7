#include "mechanics/liquid/proved_line.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/interval_arithmetic.hpp"
#include "convex/obstacle_problem/line_enclosure.hpp"

namespace mechanics::liquid {
namespace {

using convex::Interval;
using convex::LineEnd;
using convex::LineSeries;
using expression::Range;
using expression::Rounded;

Interval interval(Rounded a) {
  return {convex::moved_down(a.value - a.radius), convex::moved_up(a.value + a.radius)};
}

/// The numbers from a.low to a.high; one number where it is exact.
Rounded ball(const Interval& a) {
  if (a.low == a.high) return a.low;
  const double centre = convex::middle(a);
  return {centre, convex::moved_up(std::max(a.high - centre, centre - a.low))};
}

Range range(const Interval& a) { return {a.low, a.high}; }

/// The ray on which the variable is the distance; in one dimension the line itself.
Ray ray(const LiquidScene& scene, const LineScene& line) {
  Ray from{};
  if (!line.radial) return from;
  if (scene.domain.shape == Domain::Shape::ball) return scene.domain.written_centre;
  // The middle of a polynomial, from a quotient of sums.
  for (std::size_t i = 0; i < scene.dimension(); ++i)
    from[i] = {line.centre[i], 32 * convex::unit_roundoff * std::abs(line.centre[i])};
  return from;
}

/// The scene with numbers that are proved.
class ProvedLine {
 public:
  ProvedLine(const LiquidScene& scene, const LineScene& line)
      : scene_(scene), line_(line), from_(ray(scene, line)) {}

  std::optional<convex::EnclosedLineObstacle> problem() const {
    convex::EnclosedLineObstacle made;
    made.power = line_.problem.power;
    made.low_kind = line_.problem.at_low.kind;
    made.high_kind = line_.problem.at_high.kind;
    if (!find_ends(made)) return std::nullopt;
    if (line_.low != nullptr &&
        !(is_certain(*line_.low, made.low) && give(*line_.low, made.low, -1, made.at_low)))
      return std::nullopt;
    if (!is_certain(*line_.high, made.high) || !give(*line_.high, made.high, 1, made.at_high))
      return std::nullopt;
    made.h = [this](const Interval& a, double width) { return source(a, width); };
    return made;
  }

 private:
  bool find_ends(convex::EnclosedLineObstacle& made) const {
    const Domain& domain = scene_.domain;
    switch (domain.shape) {
      case Domain::Shape::box:
        made.low = interval_as_written(domain.written[0]);
        made.high = interval_as_written(domain.written[1]);
        return true;
      case Domain::Shape::ball:
        made.high = interval_as_written(domain.written[0]);
        if (line_.radial) return true;
        made.low = interval(domain.written_centre[0] - domain.written[0]);
        made.high = interval(domain.written_centre[0] + domain.written[0]);
        return true;
      case Domain::Shape::inequalities: {
        const bool has_centre = line_.problem.at_low.kind == LineEnd::Kind::centre;
        if (!has_centre && !find_root(line_.problem.low, 1, made.low)) return false;
        if (!find_root(line_.problem.high, -1, made.high)) return false;
        return is_inside({has_centre ? 0 : made.low.high, made.high.low}, 0);
      }
      case Domain::Shape::polygon:
        break;
    }
    return false;
  }

  static Interval interval_as_written(Rounded a) {
    return a.is_exact() ? Interval{a.value, a.value} : interval(a);
  }

  /// The least interval tried around a root of the level that has it inside on one side and outside on the
  /// other; `inwards`: the side of the liquid.
  bool find_root(double at, double inwards, Interval& root) const {
    constexpr double widening = 4, widest = 0x1p-30;
    const double size = std::max(std::abs(at), scene_.domain.longest());
    for (double width = 4 * convex::unit_roundoff; width <= widest; width *= widening) {
      const double in = at + inwards * width * size, out = at - inwards * width * size;
      if (!(scene_.domain.condition->range(region(from_, {in, in})).high < 0) ||
          !(scene_.domain.condition->range(region(from_, {out, out})).low > 0))
        continue;
      root = {std::min(in, out), std::max(in, out)};
      return true;
    }
    return false;
  }

  bool is_inside(const Interval& r, int halvings) const {
    constexpr int most_halvings = 60;
    if (scene_.domain.condition->range(region(from_, range(r))).high < 0) return true;
    const double half = convex::middle(r);
    if (halvings == most_halvings || !(r.low < half && half < r.high)) return false;
    return is_inside({r.low, half}, halvings + 1) && is_inside({half, r.high}, halvings + 1);
  }

  /// What holds at an end for certain: each part tried holds clearly there, or clearly not. An end that is
  /// written as the bound of a condition, x <= 0 at low = 0, is meant to be in it.
  bool is_certain(const BoundaryPart& part, const Interval& end) const {
    const double reach = scene_.domain.reach();
    const Range around{end.low - reach, end.high + reach};
    for (const BoundaryPart& tried : scene_.parts) {
      const Range level = tried.where.range(region(from_, around));
      if (level.high < 0) return &tried == &part;
      if (!(level.low > 0) && tried.where.level(line_.at(convex::middle(end))) != 0) return false;
      if (&tried == &part) return true;
    }
    return false;
  }

  /// The pressure there, or ρ (F·n - a).
  bool give(const BoundaryPart& part, const Interval& end, double side, Interval& given) const {
    const auto value = [&](const Field& field) { return field.along(from_, ball(end), 0).c[0]; };
    Rounded found = value(part.value);
    if (!part.is_free) {
      const Rounded along = scene_.force.empty() ? Rounded(0) : Rounded(side) * value(scene_.force.front());
      found = scene_.written_density * (along - found);
    }
    given = interval_as_written(found);
    return std::isfinite(given.low) && std::isfinite(given.high);
  }

  LineSeries source(const Interval& a, double width) const {
    constexpr int order = static_cast<int>(LineSeries::most);
    const Interval whole{a.low, convex::moved_up(a.high + width)};
    const expression::TimeSeries here = scene_.h.along(from_, ball(a), order),
                                 there = scene_.h.along(from_, ball(whole), order);
    LineSeries made;
    made.degree = LineSeries::most;
    bool is_smooth = true;
    for (std::size_t j = 0; j <= made.degree; ++j) {
      const Rounded c = j < made.degree ? here.c[j] : there.c[j];
      made.c[j] = interval_as_written(c);
      // A choice that is made here but not all over the piece has no coefficients there.
      for (const Rounded& one : {c, there.c[j]})
        is_smooth = is_smooth && std::isfinite(one.value) && std::isfinite(one.radius);
    }
    if (is_smooth) return made;
    const Range values = scene_.h.range(region(from_, range(whole)));
    made.degree = 0;
    made.c.fill({});
    made.c[0] =
        values.is_empty() ? Interval{-convex::infinity, convex::infinity} : Interval{values.low, values.high};
    const bool is_bounded = std::isfinite(made.c[0].low) && std::isfinite(made.c[0].high);
    if (!is_bounded && !line_.radial) {
      const Range load = scene_.load_range(range(whole));
      if (std::isfinite(load.low) && std::isfinite(load.high)) made.mass = Interval{load.low, load.high};
    }
    return made;
  }

  const LiquidScene& scene_;
  const LineScene& line_;
  Ray from_;
};

/// The largest of the pressure that is proved, where the one found is farther from it than the bound.
void find_largest(const convex::LineSolution& solution, const LineScene& line,
                  const convex::LineEnclosure& enclosure, LiquidSolution& found) {
  double at = line.variable(found.largest_at), largest = enclosure.p(at);
  for (const double r : solution.places())
    if (enclosure.p(r) > largest) largest = enclosure.p(at = r);
  if (std::abs(largest - found.largest) <= enclosure.error_bound) return;
  found.largest = largest;
  found.largest_at = line.at(at);
}

}  // namespace

void prove_line(const LiquidScene& scene, const LineScene& line, const LiquidAccuracy& accuracy,
                LiquidSolution& found) {
  const ProvedLine proved(scene, line);
  const std::optional<convex::EnclosedLineObstacle> problem = proved.problem();
  if (!problem) {
    found.unproved = "where the line ends, or which part holds there, is in doubt";
    return;
  }
  const convex::LineSolution solution = convex::solve_line(line.problem);
  const std::optional<convex::LineEnclosure> enclosure = convex::enclose_line(*problem, solution);
  if (!enclosure) {
    found.unproved = scene.has_free_part() ? "h, as its terms are written, has no bound on a part of the line"
                                           : "without a free part nothing takes up what rounding leaves";
    return;
  }
  found.is_proved = true;
  found.error_bound = enclosure->error_bound;
  find_largest(solution, line, *enclosure, found);
  const double size = found.largest > 0 ? found.largest : scene.pressure_scale();
  found.status = found.error_bound <= accuracy.part() * size ? LiquidSolution::Status::solved
                                                             : LiquidSolution::Status::inaccurate;
  found.p = [line, p = enclosure->p](const Point& x) { return p(line.variable(x)); };
}

}  // namespace mechanics::liquid
