#include "convex/operations/value_near.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/gamma0/node.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"

namespace convex::inline operations {
namespace {

/// What weighs more than most functions, as `stiffest_weight` does than any.
constexpr double nearest_point_weight = 1e12;

/// The product with y.lo is right to so many roundings of its terms.
constexpr double roundings_of_a_term = 4;

/// Values that are right to more than so many roundings of themselves are not those of a formula.
constexpr double roundings_of_a_formula = 64;

/// The neighbours of y among doubles on the side that `lo` lies on.
Vector beyond(const Vector& y, const Vector& lo) {
  Vector next = y;
  for (Index i = 0; i < y.size(); ++i)
    if (lo[i] != 0) next[i] = std::nextafter(y[i], lo[i] * infinity);
  return next;
}

/// How far f rises from a point inside its domain to y, where it is +inf: from how much it rises over the
/// first half of the way and over half of the rest. Where it rises no less there, as -log x and 1/x do
/// towards 0, without end.
double rise_towards(const Function& f, const Vector& y, const Vector& inside, const Value& there) {
  const auto at = [&](double part) {
    const Value value = f.evaluate(y + part * (inside - y));
    return std::isfinite(value.error) ? value.value : std::numeric_limits<double>::quiet_NaN();
  };
  const double first = at(0.5) - there.value;
  if (!std::isfinite(first) || !(first > 0)) return 0;
  const double rounding = roundings_of_a_term * (unit_roundoff * std::abs(there.value) + there.error);
  const double next = at(0.25) - at(0.5);
  if (!std::isfinite(next) || first <= 2 * rounding) return 2 * first;
  const double slower = first - std::max(next, 0.0);
  return slower > rounding ? first * std::max(2.0, first / slower) : infinity;
}

/// By how much f(y.hi + y.lo) may differ from f(y.hi), which is `there`: f is convex along y.lo.
double change_along(const Function& f, const DoubleDoubleVector& y, const Value& there) {
  constexpr double far = 0x1p26;  // on both sides, so that what the values round counts little
  double most = 0;
  for (const double side : {far, -far}) {
    const Value end = f.evaluate(y.hi + side * y.lo);
    const double rise = std::max(end.value - there.value, 0.0) + end.error + there.error;
    most = std::max(most, std::isnan(rise) ? infinity : rise / far);
  }
  return most;
}

}  // namespace

double length_of(const Vector& x) {
  const double length = x.norm();
  return has_squares(length) ? length : x.stableNorm();
}

NearValue near_value(const Function& f, const Vector& y, double size) {
  const Value value = f.evaluate(y);
  const bool decided = !(value.value == infinity) && std::isfinite(value.error);
  if (decided || f.facts().finite || !(size > 0)) return {value};
  // A function that is steep at its domain's edge gains by leaving it; the stiffer, the less. One that rises
  // there without end, as |p|³/s² at s = 0, is told the better the farther the point is inside.
  const double near = std::min(size, 1.0);
  NearValue best{value};
  double least = infinity;
  for (const double stiff : {stiffest_weight, nearest_point_weight}) {
    const double weight = f.facts().indicator ? 1 : stiff / (near * near);
    if (!std::isfinite(weight) || !(weight > 0) || WorkLimit::passed()) continue;
    WorkLimit::count(WorkLimit::of_a_nearest_point);
    const Prox nearest = f.prox(y, Metric::diagonal(Vector::Constant(y.size(), weight)), Look{});
    if (nearest.x.size() != y.size()) continue;
    const double moved = length_of(nearest.x - y);
    const Value membership = indicated(moved, size);
    if (membership.value > 0) continue;
    const Value inside = f.evaluate(nearest.x);
    if (!std::isfinite(inside.value)) continue;
    const double rise = rise_towards(f, y, nearest.x, inside);
    if (rise == infinity) return {{infinity, infinity}};
    const Value farther = f.evaluate(2 * nearest.x - y);
    const double fall = std::isfinite(farther.value) ? std::max(0.0, inside.value - farther.value) : 0;
    const Value found{inside.value, inside.error + membership.error + rise};
    if (best.value.value == infinity || found.error + fall < least) best = {found, moved};
    least = std::min(least, found.error + fall);
    if (rise + fall == 0) break;
  }
  return best;
}

NearValue near_value(const Function& f, const DoubleDoubleVector& y, double size) {
  if (!y.lo.isZero(0) && y.lo.allFinite())
    if (const auto own = f.node().evaluate_pair(y); own && std::isfinite(own->value + own->error))
      return {*own};
  NearValue near = near_value(f, y.hi, size);
  Value& found = near.value;
  const bool by_formula = found.error <= roundings_of_a_formula * unit_roundoff * std::abs(found.value);
  if (!std::isfinite(found.value) || y.lo.isZero(0) || !y.lo.allFinite()) return near;
  const std::optional<Vector> v = f.subgradient(y.hi);
  if (!v || !v->allFinite()) {
    found.error += change_along(f, y, found);
    return near;
  }
  const double more = v->dot(y.lo);
  if (!by_formula && std::abs(more) <= found.error) {
    found.error += std::abs(more);
    return near;
  }
  found.value += more;
  found.error += roundings_of_a_term * unit_roundoff * v->cwiseAbs().dot(y.lo.cwiseAbs());
  if (std::abs(more) <= unit_roundoff * std::abs(found.value)) return near;
  // Along y.lo the slope is between those at both ends.
  const std::optional<Vector> at_end = f.subgradient(beyond(y.hi, y.lo));
  const bool bounded = at_end && at_end->allFinite();
  found.error += bounded ? (*at_end - *v).cwiseAbs().dot(y.lo.cwiseAbs()) : std::abs(more);
  return near;
}

Value value_near(const Function& f, const Vector& y, double size) { return near_value(f, y, size).value; }

Value value_near(const Function& f, const DoubleDoubleVector& y, double size) {
  return near_value(f, y, size).value;
}

DoubleDoubleVector quotient(const Vector& x, double s) {
  DoubleDoubleVector found(Vector(x / s));
  for (Index i = 0; i < x.size(); ++i) {
    const DoubleDouble back = two_product(s, found.hi[i]);
    const double left = ((x[i] - back.hi) - back.lo) / s;
    if (std::isfinite(left)) found.lo[i] = left;
  }
  return found;
}

DoubleDoubleVector quotient(const DoubleDoubleVector& x, DoubleDouble s) {
  DoubleDoubleVector found(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const DoubleDouble entry = quotient(DoubleDouble{x.hi[i], x.lo[i]}, s);
    found.hi[i] = entry.hi;
    if (std::isfinite(entry.lo)) found.lo[i] = entry.lo;
  }
  return found;
}

DoubleDoubleVector difference(const DoubleDoubleVector& x, const Vector& b) {
  DoubleDoubleVector found(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const DoubleDouble entry = add({x.hi[i], x.lo[i]}, {-b[i], 0});
    found.hi[i] = entry.hi;
    found.lo[i] = entry.lo;
  }
  return found;
}

DoubleDoubleVector difference(const Vector& x, const Vector& b) {
  DoubleDoubleVector found(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const DoubleDouble exact = two_sum(x[i], -b[i]);
    found.hi[i] = exact.hi;
    found.lo[i] = exact.lo;
  }
  return found;
}

}  // namespace convex::inline operations
