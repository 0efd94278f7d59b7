#include "convex/operations/average_by_proxes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "convex/double_double.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/linear_algebra/pivoted_qr.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/nearest_member.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/root_bracket.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

/// What the search for u may take of the work that its question may.
constexpr double part_of_mean = 0.05;

/// Beyond, Newton's steps by differences cost more than they tell.
constexpr Index most_entries = 16;
constexpr int most_newton_steps = 40, most_cuts = 12;

/// The mean of the proxes is right to so many roundings of u and of the points.
constexpr double roundings_of_a_mean = 8;

/// The proxes at u.
struct MeanAt {
  Vector u, p, q;
  Vector missing;  ///< x less the mean of p and q
};

/// The u at which the mean of the proxes is x.
class MeanRoot {
 public:
  MeanRoot(const AverageOf& of, const Vector& x) : of_(of), x_(x), step_(times(1 / of.gamma, of.M)) {}

  std::optional<MeanAt> find() const { return x_.size() == 1 ? in_bracket() : by_newton(); }

 private:
  std::optional<MeanAt> at(const Vector& u) const {
    constexpr double farthest = 0x1p500;  // products with larger numbers may leave the range of doubles
    if (WorkLimit::passed() || !(u.cwiseAbs().maxCoeff() <= farthest)) return std::nullopt;
    const Prox p = of_.f.prox(u, step_), q = of_.g.prox(u, step_);
    for (const Prox* part : {&p, &q}) {
      WorkLimit::count(part->route == ProxRoute::closed_form ? 1 : WorkLimit::of_a_program);
      if (part->status != Status::solved || part->x.size() != u.size()) return std::nullopt;
    }
    MeanAt found{u, p.x, q.x, x_ - of_.t * p.x - (1 - of_.t) * q.x};
    if (!found.missing.allFinite()) return std::nullopt;
    return found;
  }
  bool is_root(const MeanAt& found) const {
    const double sizes = found.u.norm() + found.p.norm() + found.q.norm() + x_.norm();
    return found.missing.norm() <= roundings_of_a_mean * unit_roundoff * sizes;
  }
  /// Of one entry the slope is to be right to roundings of x, as a bracket can tell.
  bool is_met(const MeanAt& found) const {
    const double sizes = std::abs(found.p[0]) + std::abs(found.q[0]) + std::abs(x_[0]);
    return std::abs(found.missing[0]) <= unit_roundoff / 2 * sizes;
  }

  std::optional<MeanAt> in_bracket() const {
    std::optional<MeanAt> low = at(x_), high = low;
    if (!low || is_met(*low)) return low;
    const bool to_right = low->missing[0] > 0;
    constexpr double growth = 16;
    // The mean moves by no more than u: the root is no nearer than what is missing.
    for (double step = 2 * low->missing[0]; low->missing[0] < 0 || high->missing[0] > 0; step *= growth) {
      auto next = at(x_ + Vector::Constant(1, step));
      if (!next || is_met(*next)) return next;
      if (to_right)
        low = std::exchange(high, std::move(next));
      else
        high = std::exchange(low, std::move(next));
    }
    RootBracket bracket(low->u[0], -low->missing[0], high->u[0], -high->missing[0]);
    while (!bracket.is_closed()) {
      auto next = at(Vector::Constant(1, bracket.next()));
      if (!next || is_met(*next)) return next;
      bracket.take(next->u[0], -next->missing[0]);
      (next->missing[0] > 0 ? low : high) = std::move(next);
    }
    return low->missing[0] <= -high->missing[0] ? low : high;
  }

  std::optional<MeanAt> by_newton() const {
    std::optional<MeanAt> best = at(x_);
    for (int step = 0; step < most_newton_steps && best && !is_root(*best); ++step) {
      const auto move = newton_move(*best);
      if (!move) return std::nullopt;
      std::optional<MeanAt> next;
      double part = 1;
      for (int cut = 0; cut < most_cuts && !next; ++cut, part /= 4) {
        next = at(best->u + part * *move);
        if (next && !(next->missing.norm() < best->missing.norm())) next.reset();
      }
      if (!next) break;
      best = std::move(next);
    }
    return best;
  }
  std::optional<Vector> newton_move(const MeanAt& from) const {
    constexpr double root_of_rounding = 0x1p-26, part_of_missing = 0x1p-4, largest = 1e-3;
    constexpr double least_slope = 0x1p-40;  // where the mean does not move with u, u goes far
    const Index n = x_.size();
    const double missing = from.missing.norm(), size = from.u.norm() + missing;
    const double apart =
        std::max(root_of_rounding * size, part_of_missing * std::min(missing, largest * size));
    Matrix J(n, n);
    for (Index i = 0; i < n; ++i) {
      const double side = std::copysign(apart, from.missing[i]);
      const auto beside = at(from.u + side * Vector::Unit(n, i));
      if (!beside) return std::nullopt;
      J.col(i) = (from.missing - beside->missing) / side;
    }
    J.diagonal().array() += least_slope;
    return linear_algebra::least_squares(J, from.missing);
  }

  const AverageOf& of_;
  const Vector& x_;
  const Metric step_;
};

/// t f(p) + (1-t) g(q) + t(1-t)/(2 gamma) ||p - q||².
Value sum_at(const AverageOf& of, const Value& f_p, const Value& g_q, const Vector& apart) {
  const Value square = product(apart, of.M.multiply(apart));
  return sum_of(sum_of(multiple_of(of.t, f_p), multiple_of(1 - of.t, g_q)),
                multiple_of(of.t * (1 - of.t) / (2 * of.gamma), square));
}

/// The envelopes' mean at u less ½||u - x||²: of the sum at p and q by which these miss x.
Value below(const AverageOf& of, const MeanAt& at, const Vector& x) {
  const Value sum = sum_at(of, of.f.evaluate(at.p), of.g.evaluate(at.q), at.p - at.q);
  const Vector beside = at.u - x + 0.5 * at.missing;
  return sum_of(sum, multiple_of(1 / of.gamma, product(at.missing, of.M.multiply(beside))));
}

double most(const Value& value) { return std::isfinite(value.value) ? value.value + value.error : INFINITY; }

}  // namespace

std::optional<Value> average_at_end_of_domain(const AverageOf& of, const Vector& x) {
  if (x.size() != 1) return std::nullopt;
  const auto a = domain_of_one(of.f), b = domain_of_one(of.g);
  if (!a || !b) return std::nullopt;
  for (const auto& [p, q] : {std::pair(a->low, b->low), std::pair(a->high, b->high)}) {
    if (!std::isfinite(p) || !std::isfinite(q)) continue;
    RunningSum beyond;
    beyond.add(two_product(of.t, p));
    beyond.add(two_product(1 - of.t, q));
    beyond.add(-x[0]);
    if (beyond.value() == 0) return average_with_second(of, Vector::Constant(1, q), x, Vector::Zero(1));
  }
  return std::nullopt;
}

Value average_with_second(const AverageOf& of, const Vector& q, const Vector& x,
                          const std::optional<Vector>& slope) {
  DoubleDoubleVector p(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const DoubleDouble part = two_product(1 - of.t, q[i]), left = two_sum(x[i], -part.hi);
    p.hi[i] = left.hi / of.t;
    const DoubleDouble back = two_product(of.t, p.hi[i]);
    p.lo[i] = (((left.hi - back.hi) - back.lo) + (left.lo - part.lo)) / of.t;
  }
  const double size = x.norm() + p.hi.norm() + q.norm();
  const NearValue near = near_value(of.f, p, size);
  const double miss =
      of.t * std::max(near.moved, miss_of(of.f, p.hi, size)) + (1 - of.t) * miss_of(of.g, q, size);
  return sum_of(sum_at(of, near.value, of.g.evaluate(q), p.hi - q), {0, cost_of_miss(miss, slope)});
}

std::optional<AverageAt> average_by_proxes(const AverageOf& of, const Vector& x) {
  if (x.size() > most_entries) return std::nullopt;
  const WorkLimit part(part_of_mean);
  const auto at = MeanRoot(of, x).find();
  if (!at) return std::nullopt;
  const AverageOf turned{of.g, of.f, 1 - of.t, of.gamma, of.M};
  const Vector slope = of.M.multiply(at->u - x) / of.gamma;
  const Value first = average_with_second(of, at->q, x, slope),
              second = average_with_second(turned, at->p, x, slope);
  const Value above = most(first) <= most(second) ? first : second, least = below(of, *at, x);
  if (!std::isfinite(above.value) || !std::isfinite(least.value)) return std::nullopt;
  const double open = std::abs(above.value - least.value) + above.error + least.error;
  return AverageAt{{above.value, open}, slope};
}

}  // namespace convex::inline operations
