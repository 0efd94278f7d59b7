#include "convex/operations/line_prox.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/composite/closed_form.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/order_of_doubles.hpp"
#include "convex/operations/tied_parts.hpp"

namespace convex::inline operations {
namespace {

/// Products with larger numbers may leave the range of doubles.
constexpr double far_end = 0x1p500;

/// From a point to twice as far from 0, and the growth of such steps.
constexpr Rank first_reach = Rank{1} << 52, growth_of_reach = 4;

/// A point on one side of the prox, with a subgradient: none at an end of the domain, where it may be
/// infinite, and where it overflows beside one.
struct Side {
  Rank rank = 0;
  std::optional<double> v;
  double x() const { return double_of(rank); }
};

/// f(x), and f*(v) = sup v u - f(u), which is attained between both sides: by no more than their distance
/// times what their subgradients leave open it is above v x - f(x). None where it is above elsewhere: the
/// subgradients are not those of the values.
std::optional<PairOfValues> values_of(const Function& f, double x, double v, const Side& left,
                                      const Side& right) {
  constexpr double roundings = 4;
  const auto height = [&](double u) {
    const Value of_f = f.evaluate(Vector::Constant(1, u));
    return Value{v * u - of_f.value,
                 of_f.error + roundings * unit_roundoff * (std::abs(v * u) + std::abs(of_f.value))};
  };
  const Value f_x = f.evaluate(Vector::Constant(1, x));
  Value f_v = height(x);
  for (const double part : {0x1p-40, 0x1p-20, 0x1p-8, 0.5, 0x1p8})
    for (const double u : {x - part * std::abs(x), x + part * std::abs(x)}) {
      const Value beside = height(u);
      if (std::isfinite(beside.value) && beside.value - beside.error > f_v.value + f_v.error)
        return std::nullopt;
    }
  f_v.error += left.v && right.v ? (right.x() - left.x()) * (*right.v - *left.v) : infinity;
  return PairOfValues{f_x, f_v, 0};
}

/// The points on both sides of the prox, where w (x - z) + v changes its sign.
class Sides {
 public:
  Sides(double z, double w, const Interval& domain)
      : z_(z),
        w_(w),
        low_(rank_of(std::max(domain.low, -far_end))),
        high_(rank_of(std::min(domain.high, far_end))),
        left_{low_, {}},
        right_{high_, {}} {}

  const Side& left() const { return left_; }
  const Side& right() const { return right_; }
  const Side& nearest() const {
    const bool at_left = !right_.v || (left_.v && std::abs(residual(left_)) <= std::abs(residual(right_)));
    return at_left ? left_ : right_;
  }
  bool is_end(const Side& side) const { return side.rank == low_ || side.rank == high_; }
  bool meet() const { return right_.rank <= left_.rank + 1; }
  /// Where slopes are not known beside an end of the domain the prox may be anywhere from there.
  double width() const {
    return (right_.v ? right_.x() : double_of(high_)) - (left_.v ? left_.x() : double_of(low_));
  }

  /// From any point, the prox is no farther than the residual there over w: of the point of the domain next
  /// to z, and where that is an end without a slope, of one inside.
  template <class Slope>
  void start(const Slope& slope) {
    const double next_to_z = std::clamp(z_, left_.x(), right_.x()), unit = std::max(1.0, std::abs(next_to_z));
    const double inwards = next_to_z == left_.x() ? unit : next_to_z == right_.x() ? -unit : 0;
    for (const double part : {0.0, 1.0, 0x1p-10, 0x1p10, 0x1p-30}) {
      const double x = std::clamp(next_to_z + part * inwards, left_.x(), right_.x());
      const auto v = slope(x);
      if (!v && inwards == 0) break;
      if (!v) continue;
      const Side at{rank_of(x), v};
      const double other = x - 2 * residual(at) / w_;
      if (residual(at) >= 0) right_ = at;
      if (residual(at) <= 0) left_ = at;
      if (residual(at) > 0) left_.rank = std::max(low_, rank_of(other));
      if (residual(at) < 0) right_.rank = std::min(high_, rank_of(other));
      break;
    }
    left_is_end_ = left_.rank == low_;
    right_is_end_ = right_.rank == high_;
  }

  /// Where a slope tells most: towards an end without one in growing steps, for near it slopes cost more and
  /// may not be known.
  double next() {
    const Rank middle = std::midpoint(left_.rank, right_.rank), reach = reach_;
    if (!left_.v == !right_.v) return double_of(middle);
    reach_ = std::min(growth_of_reach * reach_, Rank{1} << 60);
    return double_of(right_.v ? std::max(middle, right_.rank - reach) : std::min(middle, left_.rank + reach));
  }

  /// Moves a side out while `is_open` there, in growing steps. False where it leads too far.
  template <class Slope, class IsOpen>
  bool move_out(bool right, const Slope& slope, const IsOpen& is_open) {
    constexpr Rank farthest = Rank{1} << 60;
    Side& side = right ? right_ : left_;
    for (Rank step = 1; side.v && is_open(side.x()); step *= growth_of_reach) {
      if (step > farthest || WorkLimit::passed()) return false;
      side.rank = right ? std::min(high_, side.rank + step) : std::max(low_, side.rank - step);
      side.v = slope(side.x());
    }
    return true;
  }

  /// What the error of the slope leaves open of the sign there: 0 where it is sure that the prox is beyond.
  double open_at(const Side& side, const FunctionNode& f) const {
    if (!side.v) return 0;
    return std::max(0.0, f.error_of_slope(side.x(), w_) - std::abs(residual(side)));
  }

  /// False where the slope is not known and this is not passed over.
  bool take(double x, const std::optional<double>& v) {
    const bool by_left = !left_.v && left_is_end_, by_right = !right_.v && right_is_end_;
    if (!v && by_left == by_right) return false;
    const Side at{rank_of(x), v};
    const bool is_left = v ? residual(at) <= 0 : by_left;
    (is_left ? left_ : right_) = at;
    return true;
  }

 private:
  double residual(const Side& at) const { return w_ * (at.x() - z_) + *at.v; }

  double z_, w_;
  Rank low_, high_;
  Side left_, right_;
  bool left_is_end_ = true, right_is_end_ = true;
  Rank reach_ = first_reach;
};

}  // namespace

std::optional<Prox> line_prox(const Function& f, double z, double w) {
  const auto domain = domain_of_one(f);
  if (!domain || !(domain->low <= domain->high) || !(std::abs(z) <= far_end)) return std::nullopt;
  const auto one = [](double e) -> Vector { return Vector::Constant(1, e); };
  if (domain->low == domain->high) {  // every slope is one there
    const double x = domain->low, v = w * (z - x);
    const Value f_x = f.evaluate(one(x));
    if (!std::isfinite(f_x.value)) return std::nullopt;
    Prox found = closed_form(one(z), Metric::diagonal(one(w)), one(x), one(v));
    found.values = PairOfValues{f_x, {v * x - f_x.value, f_x.error + unit_roundoff * std::abs(v * x)}, 0};
    return found;
  }
  const auto slope = [&](double x) -> std::optional<double> {
    const auto v = f.subgradient(Vector::Constant(1, x));
    WorkLimit::count();
    return v && std::isfinite((*v)[0]) ? std::optional((*v)[0]) : std::nullopt;
  };
  Sides sides(z, w, *domain);
  sides.start(slope);
  while (!sides.meet()) {
    if (WorkLimit::passed()) return std::nullopt;
    const double x = sides.next();
    if (!sides.take(x, slope(x))) return std::nullopt;
  }
  const Side nearest = sides.nearest();
  // Where the parts of a maximum tie to rounding its slopes are known beside the tie alone.
  const auto is_open = [&](double x) { return is_tied(f, Vector::Constant(1, x)); };
  if (!sides.move_out(false, slope, is_open) || !sides.move_out(true, slope, is_open)) return std::nullopt;
  if (!nearest.v && !sides.is_end(nearest)) return std::nullopt;
  const double x = nearest.x();
  const double v =
      std::clamp(w * (z - x), sides.left().v.value_or(-infinity), sides.right().v.value_or(infinity));
  const auto values = values_of(f, x, v, sides.left(), sides.right());
  if (!values) return std::nullopt;
  const double of_slopes =
      std::max(sides.open_at(sides.left(), f.node()), sides.open_at(sides.right(), f.node()));
  Prox found = closed_form(one(z), Metric::diagonal(one(w)), one(x), one(v));
  constexpr double roundings = 4;
  found.error_bound +=
      std::sqrt(w) * sides.width() + (of_slopes + roundings * unit_roundoff * std::abs(v)) / std::sqrt(w);
  found.route = ProxRoute::iterative;
  found.method = "bisection";
  if (std::isfinite(values->f_v.error)) found.values = values;
  return found;
}

}  // namespace convex::inline operations
