#include "mechanics/liquid/proved_line.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics::liquid {
namespace {

using expression::Rounded;

/// A closed form of p as doubles, evaluated with some forty roundings of what it is the sum of.
constexpr double roundings_of_form = 40;

/// How much wider a bracket of the edge becomes at each try, and the widest tried, both relative.
constexpr double first_width = 1e-15, widest = 1e-6, widening = 4;

bool is_above(Rounded a) { return a.value > 0 && a.value > a.radius; }
bool is_below(Rounded a) { return is_above(-a); }
double size(Rounded a) { return expression::widened(std::abs(a.value) + a.radius); }

/// What holds at the points of one end for certain: the first part tried claims all of the boundary, or the
/// point lies clearly inside or outside of each part tried.
bool is_certain(const LiquidScene& scene, const BoundaryPart& part, const Point& x, bool whole) {
  for (const BoundaryPart& tried : scene.parts) {
    if (tried.where.is_always()) return &tried == &part;
    if (whole || std::abs(tried.where.level(x)) <= scene.domain.reach()) {
      // An end that is written as the bound of a condition, x <= 0 at low = 0, is meant to be in it.
      if (whole || tried.where.level(x) != 0) return false;
    }
    if (&tried == &part) return true;
  }
  return false;
}

struct ClosedForm {
  double bound = 0, largest = 0, largest_at = 0;
  std::function<double(double)> p;
};

/// P(r; s) in two or three dimensions: P = P' = 0 at s, -ΔP = h beyond.
template <class Real>
Real beyond_edge(std::size_t d, Real h, Real r, Real s) {
  using std::log;
  if (d == 2) return -h * ((r * r - s * s) / Real(4) - s * s / Real(2) * log(r / s));
  return -h * ((r * r - s * s) / Real(6) - s * s / Real(3) + s * s * s / (Real(3) * r));
}

/// A disc or ball of radius R with p0 all around.
std::optional<ClosedForm> ball_form(std::size_t d, Rounded h, Rounded p0, Rounded R, const Point& centre) {
  const double twice = 2 * static_cast<double>(d);
  ClosedForm form;
  const Rounded at_centre = p0 + h * (R * R) / Rounded(twice);
  // P depends on R, h and p0 with these slopes at most; the variable r is known to some roundings of R.
  const double span = size(R), rounding = roundings_of_form * convex::unit_roundoff;
  const double data =
      p0.radius + size(h) * span * R.radius + span * span * h.radius +
      rounding * (size(p0) + size(h) * span * (span + std::hypot(centre[0], centre[1], centre[2])));
  const bool never_cavitates = is_above(h) || (h.value == 0 && h.radius == 0);
  if (!is_below(h) || !is_below(at_centre)) {
    if (!never_cavitates && !is_above(at_centre)) return std::nullopt;
    form.bound = expression::widened(data);
    form.largest = std::max(p0.value, at_centre.value);
    form.largest_at = at_centre.value > p0.value ? 0 : R.value;
    form.p = [twice, h = h.value, p0 = p0.value, R = R.value](double r) {
      return p0 + h * ((R - r) * (R + r)) / twice;
    };
    return form;
  }
  if (!is_above(p0)) return std::nullopt;
  double low = 0, high = R.value;  // of the edge: P(R; s) falls with s
  for (int halving = 0; halving < 200; ++halving) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (beyond_edge(d, h.value, R.value, middle) > p0.value ? low : high) = middle;
  }
  const double s = low;
  const auto over = [&](double edge) { return beyond_edge(d, h, R, Rounded(edge)) - p0; };
  for (double width = first_width; width <= widest; width *= widening) {
    const double above = s - width * R.value, below = std::min(s + width * R.value, R.value - R.radius);
    if (!(above > 0) || !is_above(over(above)) || !is_below(over(below))) continue;
    // |∂P/∂s| = |h| s^(d-1) (φ(R) - φ(s)) <= |h| R / 2.
    form.bound = expression::widened((below - above) * size(h) * span + data);
    form.largest = p0.value;
    form.largest_at = R.value;
    form.p = [d, h = h.value, s](double r) { return r <= s ? 0 : std::max(0.0, beyond_edge(d, h, r, s)); };
    return form;
  }
  return std::nullopt;
}

/// An interval with the pressures at its ends.
std::optional<ClosedForm> interval_form(Rounded h, Rounded at_low, Rounded at_high, Rounded low,
                                        Rounded high) {
  ClosedForm form;
  const Rounded length = high - low;
  const double span = size(length), rounding = roundings_of_form * convex::unit_roundoff;
  const double load = size(h) * span * span, most = std::max(size(at_low), size(at_high));
  // Slopes of p by the ends' places and values, h, and by the variable.
  const double slope = load / span + (is_above(length) ? 2 * most / (length.value - length.radius) : 0);
  const double data = at_low.radius + at_high.radius + span * span * h.radius +
                      slope * (low.radius + high.radius) +
                      rounding * (most + load + slope * (std::abs(low.value) + std::abs(high.value)));
  if (!is_above(length) || at_low.value < 0 || at_high.value < 0) return std::nullopt;
  form.bound = expression::widened(data);
  form.largest = std::max(at_low.value, at_high.value);
  form.largest_at = at_low.value >= at_high.value ? low.value : high.value;
  const double a = low.value, b = high.value;
  const bool pulls = is_below(h);
  if (!pulls && !(h.value == 0 && h.radius == 0)) return std::nullopt;  // the largest is inside
  if (pulls) {
    const Rounded left = sqrt(Rounded(2) * at_low / -h), right = sqrt(Rounded(2) * at_high / -h);
    const Rounded cavity = length - left - right;
    if (!is_above(cavity) && !is_below(cavity)) return std::nullopt;
    if (is_above(cavity)) {
      const double l = a + left.value, r = b - right.value;
      form.bound = expression::widened(data + size(h) * span * (left.radius + right.radius));
      form.p = [h = h.value, l, r](double x) {
        const double away = x < l ? l - x : x > r ? x - r : 0;
        return -0.5 * h * away * away;
      };
      return form;
    }
  }
  form.p = [h = h.value, a, b, p = at_low.value, q = at_high.value](double x) {
    return p + (q - p) * ((x - a) / (b - a)) + 0.5 * h * ((x - a) * (b - x));
  };
  return form;
}

std::optional<ClosedForm> closed_form(const LiquidScene& scene, const LineScene& line) {
  const Domain& domain = scene.domain;
  if (!scene.h.is_constant()) return std::nullopt;
  const Rounded h = scene.h.constant();
  const Point low = line.at(line.problem.low), high = line.at(line.problem.high);
  const auto is_given = [&](const BoundaryPart* part) { return part->is_free && part->value.is_constant(); };
  if (line.radial) {
    const bool plain = domain.shape == Domain::Shape::ball && is_given(line.high) &&
                       is_certain(scene, *line.high, high, true);
    if (!plain) return std::nullopt;
    return ball_form(scene.dimension(), h, line.high->value.constant(), domain.written[0], line.centre);
  }
  if (domain.shape != Domain::Shape::box || !is_certain(scene, *line.low, low, false) ||
      !is_certain(scene, *line.high, high, false))
    return std::nullopt;
  const auto [a, b] = domain.written;
  if (is_given(line.low) && is_given(line.high))
    return interval_form(h, line.low->value.constant(), line.high->value.constant(), a, b);
  // A wall at one end, and h = 0: p falls in a line to what the wall leaves, or to 0.
  if (h.value != 0 || h.radius != 0 || is_given(line.low) == is_given(line.high)) return std::nullopt;
  const bool wall_is_low = is_given(line.high);
  const BoundaryPart &wall = wall_is_low ? *line.low : *line.high,
                     &free = wall_is_low ? *line.high : *line.low;
  if (wall.is_free || !wall.value.is_constant() ||
      std::any_of(scene.force.begin(), scene.force.end(), [](const Field& f) { return !f.is_constant(); }))
    return std::nullopt;
  Rounded along = -wall.value.constant();
  for (const Field& force : scene.force) along += wall_is_low ? -force.constant() : force.constant();
  const Rounded p0 = free.value.constant(), left = p0 + scene.written_density * along * (b - a);
  if (!is_above(left) && !is_below(left)) return std::nullopt;
  const Rounded at_wall = is_above(left) ? left : Rounded(0);
  return interval_form(h, wall_is_low ? at_wall : p0, wall_is_low ? p0 : at_wall, a, b);
}

}  // namespace

void prove_line(const LiquidScene& scene, const LineScene& line, const LiquidAccuracy& accuracy,
                LiquidSolution& found) {
  const std::optional<ClosedForm> form = closed_form(scene, line);
  if (!form) return;
  found.is_proved = true;
  found.error_bound = form->bound;
  found.largest = form->largest;
  found.largest_at = line.at(form->largest_at);
  found.status = form->bound <= accuracy.part() * found.largest ? LiquidSolution::Status::solved
                                                                : LiquidSolution::Status::inaccurate;
  found.p = [line, p = form->p](const Point& x) { return p(line.variable(x)); };
}

}  // namespace mechanics::liquid
