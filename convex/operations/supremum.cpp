#include "convex/operations/supremum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/exact/exact_sum.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/line_supremum.hpp"
#include "convex/operations/one_at_a_time.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/order_of_doubles.hpp"
#include "convex/operations/sum.hpp"

namespace convex::inline operations {
namespace {

constexpr double first_step = 1e-3, last_step = 1e-150, power = 1.5;  ///< t_(k+1) = t_k^power, for |v| <= 1
constexpr int step_limit = 32, most_missed = 3;  ///< missed: proxes that do not come out before the end

/// t_k is at least this part of |v|/|x_k|: the prox of a point is right relative to the point. Where x_k has
/// crept for so many steps that is worth less than longer ones.
constexpr double smallest_part = 1e-6, smallest_creeping = 1e-10;
constexpr int creeping_steps = 8;

/// Values that agree to this part, of themselves or of `small`, have settled.
constexpr double settled = 1e-12, small = 1e-3;

/// An increase larger than the one before by this, `growth_steps` times in a row, is growth without end: log
/// 1/t grows by `power`; on the way to a maximum far away the increases grow for some steps only.
constexpr double growing = 1.3;
constexpr int growth_steps = 8;
/// Beyond, a look along each costs more than the search.
constexpr Index most_axes = 64;

/// So much farther out than it began.
constexpr double farther = 1e12;

/// The scalar products and values of a lower bound are right to so many roundings.
constexpr double roundings = 8;

/// The prox in t times the plain metric; without x where that is lost beside a quadratic term of f.
Prox prox_of(const Function& f, const Vector& z, double t) {
  try {
    return f.prox(z, Metric::diagonal(Vector::Constant(z.size(), t)));
  } catch (const InvalidInput&) {
    return {};
  }
}

/// f∞(d) < v·d, beyond rounding: then v·x - f(x) grows without end along d.
bool recedes(const Function& f, const Vector& v, const Vector& d) {
  const double slope = f.node().recession(d), along = v.dot(d);
  return slope < along - membership_tolerance * (v.cwiseAbs().dot(d.cwiseAbs()) + std::abs(slope));
}

/// The entries of x that are more than rounding, as a direction.
Vector direction_of(const Vector& x) {
  const double length = x.norm();
  if (!(length > 0) || !std::isfinite(length)) return Vector::Zero(x.size());
  return (x / length).unaryExpr([](double e) { return std::abs(e) > membership_tolerance ? e : 0.0; });
}

/// Along v and the axes.
bool recedes_plainly(const Function& f, const Vector& v) {
  const Index n = v.size();
  if (v.norm() > 0 && recedes(f, v, direction_of(v))) return true;
  if (n > most_axes) return false;
  for (Index i = 0; i < n; ++i)
    for (const double sign : {1.0, -1.0})
      if (recedes(f, v, sign * Vector::Unit(n, i))) return true;
  return false;
}

/// For a sum of one entry and v at an end of its slopes, v = f∞(d) d: v x - f(x) is a sum of f_i∞(d) x -
/// f_i(x), d = 1, each of which increases to f_i*(f_i∞(d) d) along d. It grows without end where one of them
/// does, as the logarithm does.
bool a_part_grows(const Function& f, const Vector& v) {
  const auto* sum = dynamic_cast<const Sum*>(&f.node());
  if (!sum || v.size() != 1) return false;
  for (const double d : {1.0, -1.0}) {
    const Vector direction = Vector::Constant(1, d);
    ExactSum left;
    left.add(-v.dot(direction));
    for (const Function& part : sum->parts()) left.add(part.node().recession(direction));
    if (left.sign() != 0) continue;
    for (const Function& part : sum->parts()) {
      const double slope = part.node().recession(direction);
      const Value end = part.conjugate().evaluate(slope * direction);
      if (end.value == infinity && end.error == 0) return true;
    }
  }
  return false;
}

/// Along t prox_f(v/t) in t times the plain metric, which for small t comes to v less its nearest point of
/// the closed domain of f* (Moreau 1965): the way out of that domain, where v is outside of it.
bool recedes_far_out(const Function& f, const Vector& v) {
  const double unit = std::max(1.0, v.norm());
  for (const double part : {1e-6, 1e-8, 1e-10, 1e-12}) {
    const double t = part * unit;
    const Prox at = prox_of(f, v / t, t);
    if (at.x.size() == v.size() && at.x.allFinite() && recedes(f, v, direction_of(at.x))) return true;
  }
  return false;
}

/// Is v·x - f(x) more than `bound` beside x along an axis, or not known there?
bool is_surpassed(const Function& f, const Vector& v, const Vector& x, double bound) {
  if (v.size() > most_axes) return false;
  for (Index i = 0; i < v.size(); ++i)
    for (const double part : {1e-6, -1e-6, 1e-3, -1e-3, 1.0, -1.0}) {
      const Vector beside = x + part * std::max(1.0, x.norm()) * Vector::Unit(v.size(), i);
      const Value value = f.evaluate(beside);
      if (!std::isfinite(value.error) || v.dot(beside) - value.value - value.error > bound) return true;
    }
  return false;
}

/// What the prox in t times the plain metric leaves open of v·x - f(x), whose slopes are of the sizes of v
/// and of the covector. One that was cut short may stand still where it began: it is as far from where it
/// should be as its bound tells. Where that tells nothing, a subgradient s at x bounds f, f(u) >= f(x) + s·(u
/// - x).
double left_by(const Prox& at, const Function& f, const Vector& v, double t) {
  if (at.status == Status::solved) return 0;
  if (std::isfinite(at.error_bound)) return (v.norm() + at.v.norm()) * at.error_bound / std::sqrt(t);
  const auto slope = f.subgradient(at.x);
  if (!slope || slope->size() != v.size()) return infinity;
  const Vector rest = v - *slope;
  return rest.isZero(0) ? 0 : std::max(0.0, f.node().domain_support(rest) - rest.dot(at.x));
}

/// A point at which v·x - f(x) is more than `bound`, far out along x, where steps that a set keeps beside 0
/// point to a far maximiser, or at the prox of v; none where neither is.
std::optional<Vector> surpassing(const Function& f, const Vector& v, const Vector& x, double bound) {
  constexpr double first = 4, last = 1.0001, most = 1e12;
  std::optional<Vector> best;
  const auto consider = [&](const Vector& far) {
    if (far.size() != v.size() || !far.allFinite()) return;
    const Value value = f.evaluate(far);
    const double terms = v.cwiseAbs().dot(far.cwiseAbs()) + std::abs(value.value);
    const double least = v.dot(far) - value.value - value.error - roundings * unit_roundoff * terms;
    if (least > bound) best = far, bound = least;
  };
  for (double times = first; times <= most && x.norm() > 0; times *= first) consider(times * x);
  for (double factor = first; best && factor > last; factor = std::sqrt(factor)) {
    const Vector middle = *best;
    consider(factor * middle);
    consider(middle / factor);
  }
  consider(prox_of(f, v, 1).x);
  return best;
}

struct Search {
  Value value;
  bool growing = false;    ///< the lower bounds grow as if without end
  bool bracketed = false;  ///< chords on both sides bound the value, and no limit of steps
};

/// Of one entry, by the chords around the greatest value, from `start` or where a prox leads; where none of
/// them bounds it, the best lower bound.
std::optional<LineSupremum> on_line(const Function& f, const Vector& v, const std::optional<Vector>& start) {
  if (v.size() != 1) return std::nullopt;
  std::optional<LineSupremum> best;
  const auto settles = [&](const Vector& x) {
    if (x.size() != 1 || !x.allFinite()) return false;
    const auto found = line_supremum(f, v[0], x[0]);
    const bool bounded = found && std::isfinite(found->value.error);
    if (found && (bounded || !best || found->value.value > best->value.value)) best = found;
    return bounded;
  };
  if (start && settles(*start)) return best;
  const double t = first_step * std::max(1.0, v.norm());
  if (settles(prox_of(f, v / t, t).x)) return best;
  // Pulled far, the prox may round to an open end of the domain.
  settles(prox_of(f, Vector::Zero(1), 1).x);
  return best;
}

Search search(const Function& f, const Vector& v, const std::optional<Vector>& start) {
  const Index n = v.size();
  if (recedes_plainly(f, v) || a_part_grows(f, v)) return {{infinity, 0}, true};
  const auto line = on_line(f, v, start);
  if (line && std::isfinite(line->value.error)) return {.value = line->value, .bracketed = true};
  Vector x = Vector::Zero(n);
  Value best{-infinity, infinity};
  Vector x_of_best;
  const double unit = std::max(1.0, v.norm());
  double part = smallest_part, t = first_step * unit, last = -infinity, highest = -infinity, before = 0,
         first_length = 0;
  int grown = 0, quiet = 0, missed = 0;
  for (int step = 0; step < step_limit; ++step) {
    const Prox at = prox_of(f, x + v / t, t);
    if (at.x.size() != n || !at.x.allFinite()) break;
    if (at.status != Status::solved && ++missed > most_missed) break;
    const Value value = f.evaluate(at.x);
    const double bound = v.dot(at.x) - value.value;
    if (!std::isfinite(bound)) break;
    const double terms = v.cwiseAbs().dot(at.x.cwiseAbs()) + std::abs(value.value);
    const double rounding = value.error + roundings * unit_roundoff * terms;
    if (bound + 4 * rounding < highest) break;  // the prox did not get there
    highest = std::max(highest, bound - rounding);
    const double moved = (at.x - x).norm(), increase = bound - last;
    // Off an end of the domain the value falls as steeply as v·x may, and x is there but for its bound.
    const double off_domain = f.facts().finite ? 0 : v.norm() * at.error_bound / std::sqrt(t);
    const double error = rounding + t * moved * at.x.norm() + std::abs(increase) + left_by(at, f, v, t);
    const double enough = settled * std::max(std::abs(bound), small) + rounding;
    // A step that cannot move x as far as x is long shows nothing.
    const bool free = v.norm() == 0 || t * at.x.norm() <= v.norm();
    const bool shrinking = std::abs(increase) <= std::max(0.5 * std::abs(before), enough);
    if (free && shrinking && error + off_domain < best.error) {
      best = {bound, error + off_domain};
      x_of_best = at.x;
    }
    quiet = free && error <= 2 * enough ? quiet + 1 : 0;
    // Of one entry chords tell where it is.
    const bool look_out = n > 1 && (quiet >= 2 || step == creeping_steps || step == 2 * creeping_steps);
    const auto farther_out = look_out ? surpassing(f, v, at.x, bound + error + enough) : std::nullopt;
    if (farther_out) {
      x = *farther_out, quiet = 0, best = {-infinity, infinity};
      t = std::max(part * v.norm() / x.norm(), last_step);
      continue;
    }
    if (quiet >= 2) break;
    if (n > 1 && step > creeping_steps) part = std::max(part / 2, smallest_creeping);
    grown = increase > growing * before && before > enough ? grown + 1 : 0;
    if (!(first_length > 0)) first_length = at.x.norm();
    const bool far = at.x.norm() >= farther * first_length;
    if (grown >= growth_steps && far && t * moved >= membership_tolerance * v.norm()) {
      const bool proved = recedes(f, v, direction_of(at.x)) || recedes(f, v, direction_of(Vector(at.x - x)));
      return {proved ? Value{infinity, 0} : Value{highest, infinity}, true};
    }
    before = std::isfinite(increase) ? increase : 0;
    last = bound;
    x = at.x;
    const double less = std::min(std::pow(t / unit, power), t / unit);
    t = std::max({unit * less, part * v.norm() / x.norm(), last_step});
    if (!std::isfinite(t)) t = first_step * unit;
  }
  // Proxes cut short, or that cannot get as far as the maximiser, stand still as if the values had settled.
  if (missed > most_missed) best.error = infinity;
  if (line && !(line->value.value <= best.value + best.error)) best = line->value;
  // That proxes stand still is what they say of each other; the values beside the point know nothing of them.
  else if (x_of_best.size() > 0 && is_surpassed(f, v, x_of_best, best.value + 4 * best.error))
    best.error = infinity;
  return {best, false};
}

}  // namespace

Value supremum(const Function& f, const Vector& v) { return search(f, v, std::nullopt).value; }

bool grows_without_end(const Function& f, const Vector& v) {
  constexpr double part = 0.3;  // it is asked before the question itself
  const WorkLimit question(part);
  return search(f, v, std::nullopt).growing;
}

namespace {

/// `found` with what v·x - f(x) at the program's own maximiser x leaves open.
Value between_bounds(const Value& found, const std::optional<Vector>& x, const Function& f, const Vector& v) {
  if (!std::isfinite(found.value)) return found;
  const OneAtATime question(OneAtATime::Kind::lower_bound);
  if (!question.first() || !x || x->size() != v.size() || !x->allFinite()) return found;
  const Value at = f.evaluate(*x);
  if (!std::isfinite(at.value)) return found;
  const double below = v.dot(*x) - at.value;
  const double rounding =
      at.error + roundings * unit_roundoff * (v.cwiseAbs().dot(x->cwiseAbs()) + std::abs(at.value));
  const double apart = std::abs(found.value - below);
  return {found.value, apart <= rounding ? found.error : std::max(found.error, apart)};
}

/// Where v is a slope of f of one entry, between the doubles at whose slopes the order to v changes.
std::optional<double> attained_at(const Function& f, double v, const LineSupremum& found) {
  constexpr double roundings_of_a_point = 64;
  Rank low = rank_of(found.around.low), high = rank_of(found.around.high);
  while (high > low + 1 && !WorkLimit::passed()) {
    if (double_of(high) - double_of(low) <= roundings_of_a_point * unit_roundoff * std::abs(found.x))
      return std::clamp(found.x, double_of(low), double_of(high));
    const Rank middle = std::midpoint(low, high);
    const auto slope = f.subgradient(Vector::Constant(1, double_of(middle)));
    WorkLimit::count();
    if (!slope || std::isnan((*slope)[0])) return std::nullopt;
    ((*slope)[0] < v ? low : high) = middle;
  }
  return high > low + 1 ? std::nullopt : std::optional(std::clamp(found.x, double_of(low), double_of(high)));
}

}  // namespace

std::optional<Vector> maximiser(const Function& f, const Vector& v) {
  const OneAtATime question(OneAtATime::Kind::supremum);
  if (!question.first() || recedes_plainly(f, v)) return std::nullopt;
  const auto found = on_line(f, v, std::nullopt);
  if (!found || !std::isfinite(found->value.error)) return std::nullopt;
  const auto x = attained_at(f, v[0], *found);
  return x ? std::optional(Vector(Vector::Constant(1, *x))) : std::nullopt;
}

bool is_of_rounding(const Value& value) {
  constexpr double few = 64;
  const double size = value.value == 0 ? small : std::abs(value.value);
  return std::isfinite(value.value) && value.error <= few * unit_roundoff * size;
}

Value settled_value(const Value& by_program, const std::optional<Vector>& x, const Function& f,
                    const Vector& v) {
  const Value found = between_bounds(by_program, x, f, v);
  // Of one entry the search costs little, and a small value is asked for relative to itself.
  const double size = std::max(std::abs(found.value), v.size() == 1 && found.value != 0 ? 0 : small);
  const bool exact = f.facts().piecewise_quadratic && found.error < infinity;
  const bool decided = exact || (std::isfinite(found.value) && found.error <= settled * size);
  const OneAtATime question(OneAtATime::Kind::supremum);
  if (decided || !question.first()) return found;
  Search searched = search(f, v, x);
  Value& other = searched.value;
  // The conjugate of a support function is 0 or +inf: a bound between them tells neither.
  if (f.facts().support && other.value < infinity && !(other.value + other.error <= settled * small))
    other = {0, infinity};
  if (!std::isfinite(found.value)) {
    // A program says +inf where it finds the domains apart, which rounding can feign, and -inf on one look.
    if (found.value == infinity && recedes_far_out(f, v)) return {infinity, 0};
    const bool agree = found.value == other.value;
    return agree || other.error < infinity ? other : Value{found.value, infinity};
  }
  const double apart = std::abs(other.value - found.value);
  if (std::isinf(other.error) && other.value > found.value + found.error) return other;
  const bool contradict = other.error < infinity && apart > other.error + found.error;
  Value best = other.error < found.error ? other : found;
  if (contradict) best = searched.bracketed ? other : Value{std::max(other.value, found.value), apart};
  // A program takes what misses the domain by less than it is solved to for a point of it.
  const bool is_open = !(best.error <= settled * std::max(std::abs(best.value), small));
  return is_open && recedes_far_out(f, v) ? Value{infinity, 0} : best;
}

}  // namespace convex::inline operations
