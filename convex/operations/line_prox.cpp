#include "convex/operations/line_prox.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/composite/work_limit.hpp"
#include "convex/functions/closed_form.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/infinity.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/order_of_doubles.hpp"

namespace convex::inline operations {
namespace {

/// Products with larger numbers may leave the range of doubles.
constexpr double far_end = 0x1p500;

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

}  // namespace

std::optional<Prox> line_prox(const Function& f, double z, double w) {
  const auto domain = domain_of_one(f);
  if (!domain || !(domain->low <= domain->high) || !(std::abs(z) <= far_end)) return std::nullopt;
  const auto slope = [&](double x) -> std::optional<double> {
    const auto v = f.subgradient(Vector::Constant(1, x));
    WorkLimit::count();
    return v && std::isfinite((*v)[0]) ? std::optional((*v)[0]) : std::nullopt;
  };
  const Rank low = rank_of(std::max(domain->low, -far_end)), high = rank_of(std::min(domain->high, far_end));
  Side left{low, {}}, right{high, {}};
  // Of the point of the domain next to z the prox is no farther than the residual there over w.
  const double start = std::clamp(z, left.x(), right.x());
  if (const auto v = slope(start)) {
    const double residual = w * (start - z) + *v, other = start - 2 * residual / w;
    if (residual >= 0) right = {rank_of(start), v};
    if (residual <= 0) left = {rank_of(start), v};
    if (residual > 0) left.rank = std::max(low, rank_of(other));
    if (residual < 0) right.rank = std::min(high, rank_of(other));
  }
  while (right.rank > left.rank + 1) {
    if (WorkLimit::passed()) return std::nullopt;
    const Rank middle = std::midpoint(left.rank, right.rank);
    const double x = double_of(middle);
    const auto v = slope(x);
    // Beside an end of the domain slopes may overflow; what is not known elsewhere is not passed over.
    const bool by_left = !left.v && left.rank == low, by_right = !right.v && right.rank == high;
    if (!v && by_left == by_right) return std::nullopt;
    const bool is_left = v ? w * (x - z) + *v <= 0 : by_left;
    (is_left ? left : right) = {middle, v};
  }
  const bool at_left = !right.v || (left.v && std::abs(w * (left.x() - z) + *left.v) <=
                                                  std::abs(w * (right.x() - z) + *right.v));
  const Side& nearest = at_left ? left : right;
  const bool is_end = nearest.rank == low || nearest.rank == high;
  if (!nearest.v && !is_end) return std::nullopt;
  const double x = nearest.x();
  const double v = std::clamp(w * (z - x), left.v.value_or(-infinity), right.v.value_or(infinity));
  const auto values = values_of(f, x, v, left, right);
  if (!values) return std::nullopt;
  const auto one = [](double e) -> Vector { return Vector::Constant(1, e); };
  Prox found = closed_form(one(z), Metric::diagonal(one(w)), one(x), one(v));
  found.error_bound += std::sqrt(w) * (right.x() - left.x());
  found.route = ProxRoute::iterative;
  found.method = "bisection";
  if (std::isfinite(values->f_v.error)) found.values = values;
  return found;
}

}  // namespace convex::inline operations
