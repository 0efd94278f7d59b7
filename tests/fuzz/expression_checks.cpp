#include "tests/fuzz/expression_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "cli/function_language/parse_call.hpp"
#include "cli/function_language/parse_metric.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/functions/decomposition.hpp"
#include "tests/fuzz/call_value.hpp"

namespace fuzz {
namespace {

using convex::Call;
using convex::Decomposition;
using convex::Function;
using convex::Index;
using convex::Metric;
using convex::Vector;

constexpr double allowed = 1e-9;        ///< of a gap, relative to its terms
constexpr double smallest_size = 1e-3;  ///< what terms count at least
constexpr double allowed_descent = 1e-8;
constexpr double growing =
    1e5;  ///< a supremum that is +inf grows so much as the search goes 1e8 times as far

/// One that rises by more than this part of itself over the last tenfold has not been reached.
constexpr double rising = 1e-2;

constexpr Real rounding_of_terms = 1e-18L;  ///< that searches leave to sums in long doubles

/// A supremum that is approached at infinity rises by less beyond 1e16 than from 1e8 to there: by 1e-4 of it
/// where it is approached as by the root.
constexpr double part_beyond = 2e-4;

struct Subject {
  Call call;
  Function f;
  Metric W;
  Vector z;
};

std::string text(const char* what, double a, double b) {
  char line[200];
  std::snprintf(line, sizeof line, "%s: %.17g beside %.17g", what, a, b);
  return line;
}

Point point(const Vector& x) { return Point(x.begin(), x.end()); }

double square(const Vector& x, const Metric& W) { return W.inner(x, x); }

/// By how much (u|y) may be off where u and y are rounded: sum over i, j of |u_i W_ij y_j| roundings.
double rounding_of_inner(const Metric& W, const Vector& u, const Vector& y) {
  constexpr double roundings = 16 * 0x1p-53;
  Vector image = Vector::Zero(y.size());
  for (Index j = 0; j < y.size(); ++j) image += (W.multiply(Vector::Unit(y.size(), j)) * y[j]).cwiseAbs();
  return roundings * u.cwiseAbs().dot(image);
}

/// What moving x by a few roundings does to f by definition, all of it or each entry by its own. Where all
/// that leaves the domain, by a few of those that the definition itself is summed with.
Real sensitivity(const Call& f, const Vector& x, Real here) {
  for (const double size : {1e-15, 1e-17, 1e-19}) {
    std::optional<Real> most;
    const auto change = [&](const Point& moved) -> Real {
      const auto there = call_value(f, moved, rounded);
      if (!there || !std::isfinite(there->value)) return 0;
      most = most.value_or(0);
      return std::abs(there->value - here);
    };
    Real of_all = 0, of_entries = 0;
    for (const double step : {size, -size}) {
      Point moved = point(x);
      for (Real& v : moved) v += step * static_cast<Real>(x.norm());
      of_all = std::max(of_all, change(moved));
      for (Index i = 0; i < x.size(); ++i) {
        moved = point(x);
        moved[static_cast<std::size_t>(i)] *= 1 + static_cast<Real>(step);
        of_entries += change(moved);
      }
    }
    if (most) return 16 * std::max(of_all, of_entries);
  }
  return 0;
}

std::string wrong_value(const Subject& subject, const Vector& x, double value) {
  const auto truth = call_value(subject.call, point(x), rounded);
  if (!truth) return "";
  if (!std::isfinite(truth->value) || !std::isfinite(value))
    return "";  // at the edge of a domain: see the gap
  const Real slack =
      allowed * std::max({std::abs(truth->value), truth->size, static_cast<Real>(smallest_size)}) +
      sensitivity(subject.call, x, truth->value);
  // Where a slope is steep, the slack that lets a rounded point in is worth more than the value's rounding:
  // the least that does counts.
  std::optional<CallValue> inside;
  for (const Real slack_of_x : {strict, 1e-16L, 1e-15L, 1e-14L, 1e-13L, 1e-12L}) {
    inside = call_value(subject.call, point(x), slack_of_x);
    if (inside && std::isfinite(inside->value)) break;
  }
  const Real most =
      inside && std::isfinite(inside->value) ? std::max(truth->value, inside->value) : truth->value;
  const Real off = static_cast<Real>(value) - truth->value;
  if (static_cast<Real>(value) - most > slack || (truth->exact && off < -slack))
    return text("f(x), and by definition", value, static_cast<double>(truth->value));
  return "";
}

/// Steps from x in all magnitudes, along the axes, towards z, 0 and the answer's own covector.
std::vector<Vector> around(const Subject& subject, const Vector& x, const Vector& y) {
  std::vector<Vector> points{Vector::Zero(x.size()), subject.z};
  std::vector<Vector> directions;
  for (Index i = 0; i < x.size(); ++i) directions.push_back(Vector::Unit(x.size(), i));
  for (Index i = 0; i + 1 < x.size(); ++i) {
    directions.push_back(Vector::Unit(x.size(), i) + Vector::Unit(x.size(), i + 1));
    directions.push_back(Vector::Unit(x.size(), i) - Vector::Unit(x.size(), i + 1));
  }
  if (x.norm() > 0) directions.push_back(x.normalized());
  if (y.norm() > 0) directions.push_back(y.normalized());
  const double size = std::max({x.norm(), subject.z.norm(), 1e-6});
  for (const Vector& direction : directions)
    for (double part = 1e-8; part < 20; part *= 10)
      for (const double sign : {-1.0, 1.0}) points.push_back(x + sign * part * size * direction);
  return points;
}

/// Of one entry, x beside the least point of the objective, which is found to the root of its rounding.
std::string wrong_minimiser(const Subject& subject, const Decomposition& split) {
  if (subject.z.size() != 1) return "";
  const Real z = subject.z[0], x = split.x.x[0], w = subject.W.diagonal()[0];
  bool exact = true;
  Real size = 0;
  const auto objective = [&](Real u) -> Real {
    const auto at = call_value(subject.call, {u}, strict);
    exact = exact && at && at->exact;
    if (!at || !std::isfinite(at->value)) return std::numeric_limits<Real>::infinity();
    const Real square = w * (u - z) * (u - z) / 2;
    if (std::abs(u - x) <= std::abs(x) + 1) size = std::max({size, at->size, std::abs(at->value), square});
    return square + at->value;
  };
  const LineMinimum least = least_on_line(objective, {x, z, 0});
  if (!exact || !std::isfinite(least.value)) return "";
  const Real bound = split.x.error_bound / std::sqrt(w),
             searched = 4 * std::sqrt(2 * 64 * rounding_of_terms * size / w) + 1e-12L * std::abs(x);
  if (std::abs(x - least.at) <= bound + searched) return "";
  return text("x, and the least point of the objective", static_cast<double>(x),
              static_cast<double>(least.at));
}

std::string wrong_split(const Subject& subject, const Decomposition& split) {
  const Vector &x = split.x.x, &y = split.y.x;
  const double size =
      std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner), smallest_size});
  const double gap = split.f_x + split.g_y - split.inner;
  if (!(std::abs(gap) <= allowed * size)) return text("gap, and its terms", gap, size);
  const double inner = subject.W.inner(x, y);
  if (!(std::abs(inner - split.inner) <= allowed * size + rounding_of_inner(subject.W, x, y)))
    return text("(x|y), and of the printed points", split.inner, inner);
  if (std::string why = wrong_value(subject, x, split.f_x); !why.empty()) return why;
  if (std::string why = wrong_minimiser(subject, split); !why.empty()) return why;
  const double objective = 0.5 * square(x - subject.z, subject.W) + split.f_x;
  const double scale =
      std::max({std::abs(split.f_x), square(subject.z, subject.W), square(x, subject.W), 1e-3});
  const double of_rounded_y = rounding_of_inner(subject.W, x, y);  // x is the slope of g at y
  for (const Vector& u : around(subject, x, y)) {
    const auto at = call_value(subject.call, point(u), strict);
    if (!at || !std::isfinite(at->value)) continue;
    const double there = 0.5 * square(u - subject.z, subject.W) + static_cast<double>(at->value);
    const double slack = allowed_descent * std::max(scale, static_cast<double>(at->size));
    if (there < objective - slack) return text("objective at a point, and at x", there, objective);
    const double bound = subject.W.inner(u, y) - static_cast<double>(at->value);
    const double large = std::max(u.norm() * subject.W.multiply(y).norm(), static_cast<double>(at->size));
    const double slack_of_y = allowed_descent * std::max({large, std::abs(split.g_y), 1e-3}) +
                              rounding_of_inner(subject.W, u, y) + of_rounded_y;
    if (bound > split.g_y + slack_of_y) return text("(u|y) - f(u) at a point, and g(y)", bound, split.g_y);
  }
  return "";
}

/// sup over |u| <= reach of u·v - f(u), for one entry, less so many of its terms.
double searched_supremum(const Call& f, double v, double reach, Real rounding, bool& exact) {
  const auto minus = [&](Real u) -> Real {
    if (std::abs(u) > reach) return std::numeric_limits<Real>::infinity();
    const auto at = call_value(f, {u}, strict);
    if (!at) {
      exact = false;
      return std::numeric_limits<Real>::infinity();
    }
    exact = exact && at->exact;
    return at->value + rounding * at->size - u * v;
  };
  return -static_cast<double>(
      least_on_line(minus, {0, 1, -1, 2, -2, 3, -3, static_cast<Real>(reach), -static_cast<Real>(reach)})
          .value);
}

/// The conjugate's values at points that are not proxes, beside suprema searched on the line.
std::string wrong_conjugate(const Subject& subject, bool& open) {
  if (subject.z.size() != 1) return "";
  const double weight = subject.W.diagonal()[0];
  const Function g = subject.f.conjugate();
  for (const double v : {0.0, 1.0, -1.0, 0.5, -2.0, -1e-12, 1e-6, weight * subject.z[0]}) {
    bool exact = true;
    // A slope that is nothing beside the function's data counts as 0.
    const bool tiny = v != 0 && std::abs(v) < 1e-9;
    const auto within = [&](double reach, Real rounding = rounding_of_terms) {
      return searched_supremum(subject.call, v, reach, rounding, exact);
    };
    const convex::Value known = g.evaluate(Vector::Constant(1, v));
    const double value = known.value;
    if (!(known.error <= allowed * (std::isfinite(value) ? std::max(1.0, std::abs(value)) : 1))) {
      open = true;  // and says so
      continue;
    }
    const double near = within(tiny ? 1e3 : 1e8);
    const double slack = 1e-7 * std::max({1.0, std::abs(value), std::abs(v)});
    if (!(value >= near - slack)) return text("conjugate, and a searched lower bound", value, near);
    // The search ends where the function does not; what is missing there is no error of the value.
    if (tiny || !(value > near + 100 * slack)) continue;
    // Terms that cancel everywhere would end the search where their rounding begins to count.
    const double far = std::max(within(1e16), within(1e16, 0));
    if (!(far > -INFINITY) || !exact || far >= growing * std::max(1.0, std::abs(near))) continue;
    // What still rises at the end of the search has its supremum beyond.
    if (std::isfinite(value) && far - within(1e15) > rising * std::abs(far)) continue;
    if (std::isinf(value)) {
      // As a logarithm does, by as much at each scale.
      if (!(far > near && far - near > 0.5 * (near - within(1e4))))
        return text("conjugate +inf, supremum searched", v, far);
    } else if (value > far + 100 * slack + part_beyond * (far - near)) {
      return text("conjugate, and the supremum searched", value, far);
    }
  }
  return "";
}

}  // namespace

Outcome outcome(const Question& question) {
  try {
    const Vector z = cli::parse_vector(question.z, "z");
    const Metric W =
        question.metric.empty() ? Metric::identity(z.size()) : cli::parse_metric(question.metric);
    set_product(question.metric.empty());
    const Call call = cli::parse_call(question.f, "f");
    const Function f = convex::make_function(call, {W});
    const Subject subject{call, f, W, z};
    const Decomposition split = convex::decompose(f, z, W);
    if (split.status == convex::Status::solved) {
      if (std::string why = wrong_split(subject, split); !why.empty()) return {Verdict::wrong, why};
    }
    const bool refused = split.status != convex::Status::solved;
    bool open = false;
    if (std::string why = wrong_conjugate(subject, open); !why.empty()) return {Verdict::wrong, why};
    if (refused)
      return {Verdict::refused, text("bound, gap", split.error_bound, split.fenchel_gap) + "; " +
                                    split.x.method + "; " + split.y.method};
    return {open ? Verdict::open : Verdict::right, ""};
  } catch (const convex::InvalidInput& error) {
    return {Verdict::invalid, error.what()};
  }
}

}  // namespace fuzz
