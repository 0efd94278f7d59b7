#include "convex/proved_prox/doubles/near_graph.hpp"

#include <cmath>

#include "convex/double_double.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"

namespace convex::near_graphs {

void NearGraph::set_x(Index i, const Interval& a) {
  x[i] = middle(a);
  x_radius[i] = moved_up(std::max(a.high - x[i], x[i] - a.low));
}

void NearGraph::set_v(Index i, const Interval& a) {
  v[i] = middle(a);
  v_radius[i] = moved_up(std::max(a.high - v[i], v[i] - a.low));
}

Interval NearGraph::x_at(Index i) const { return outwards(x[i] - x_radius[i], x[i] + x_radius[i]); }
Interval NearGraph::v_at(Index i) const { return outwards(v[i] - v_radius[i], v[i] + v_radius[i]); }

namespace {

/// A sum in twice the working precision of terms whose sizes add up to `magnitude` (Ogita, Rump and Oishi
/// 2005, propositions 4.5 and 5.5).
Interval enclosed(const RunningSum& total, double magnitude, Index terms) {
  const double value = total.value();
  const double error =
      moved_up(unit_roundoff * std::abs(value) + above(gamma(terms) * gamma(terms) * magnitude), 2);
  return {moved_down(value - error), moved_up(value + error)};
}

}  // namespace

Interval sum(const Vector& x) {
  if ((x.array() != 0).count() <= 1) return interval_at(x.sum());
  RunningSum total;
  for (const double entry : x) total.add(entry);
  return enclosed(total, x.cwiseAbs().sum(), x.size());
}

Interval product_sum(const Vector& a, const Vector& b) {
  RunningSum total;
  double magnitude = 0;
  for (Index i = 0; i < a.size(); ++i) {
    total.add(two_product(a[i], b[i]));
    magnitude += std::abs(a[i] * b[i]);
  }
  const Interval made = enclosed(total, magnitude * 2, a.size());
  constexpr double underflow = 1e-300;  // more than products lose to it
  return {made.low - underflow, made.high + underflow};
}

Interval square_sum(const Vector& x) {
  const Interval made = product_sum(x, x);
  return {std::max(0.0, made.low), made.high};
}

Interval inner_product(const NearGraph& pair) {
  const Interval middle = product_sum(pair.x, pair.v);
  const Vector x = pair.x.cwiseAbs() + pair.x_radius, v = pair.v.cwiseAbs() + pair.v_radius;
  const double spread = x.dot(pair.v_radius) + pair.x_radius.dot(v) + x.norm() * pair.v_ball +
                        pair.x_ball * (v.norm() + pair.v_ball);
  return {moved_down(middle.low - above(spread)), moved_up(middle.high + above(spread))};
}

NearGraph turned_round(NearGraph pair) {
  const Interval inner = inner_product(pair), f_v = inner - pair.f_x;
  std::swap(pair.x, pair.v);
  std::swap(pair.x_radius, pair.v_radius);
  std::swap(pair.x_ball, pair.v_ball);
  pair.f_x = {f_v.low, moved_up(f_v.high + pair.gap)};
  return pair;
}

namespace {

/// Of the whole or of each group: the norm, or the ball where `is_ball`.
MaybeNear of_groups(const IntervalArguments& a, bool is_ball, const Vector& x, const Vector& v) {
  const Interval weight = a.number(is_ball ? "radius" : "weight");
  const bool given = a.is_vector("sizes");
  const std::vector<Interval> sizes = given ? a.vector("sizes") : std::vector<Interval>{a.number("sizes")};
  NearGraph whole(x.size());
  Index first = 0;
  for (std::size_t k = 0; first < x.size(); ++k) {
    const auto n = static_cast<Index>(sizes[given ? k : 0].low);
    const Vector point = x.segment(first, n), covector = v.segment(first, n);
    const NearGraph part =
        is_ball ? turned_round(of_norm2(weight, covector, point)) : of_norm2(weight, point, covector);
    whole.x.segment(first, n) = part.x;
    whole.x_radius.segment(first, n) = part.x_radius;
    whole.v.segment(first, n) = part.v;
    whole.v_radius.segment(first, n) = part.v_radius;
    whole.gap = moved_up(whole.gap + part.gap);
    whole.f_x = whole.f_x + part.f_x;
    first += n;
  }
  if (is_ball) whole.f_x = {0, 0};
  return whole;
}

/// The pair of an indicator: whatever the formula made of the value.
MaybeNear indicator_of(MaybeNear pair) {
  if (pair) pair->f_x = {0, 0};
  return pair;
}

MaybeNear turned(MaybeNear pair) {
  if (!pair) return pair;
  return turned_round(std::move(*pair));
}

}  // namespace

std::optional<NearGraph> near_graph(const Call& f, const Metric& W, const Vector& x, const Vector& v) {
  const std::string& name = f.name;
  const IntervalArguments a(f, x.size());
  if (name == "indicator") return near_graph(a.call("set"), W, x, v);
  if (name == "norm2") return of_norm2(a.number("weight"), x, v);
  if (name == "ball2") {
    const std::vector<Interval> centre = a.vector("center");
    NearGraph made = turned_round(of_norm2(a.number("radius"), v, x - middles(centre)));
    move_by(made.x, made.x_radius, centre);
    return indicator_of(std::move(made));
  }
  if (name == "group_norm") return of_groups(a, false, x, v);
  if (name == "group_ball") return of_groups(a, true, x, v);
  if (name == "second_order_cone") return of_second_order_cone(x, v);
  if (name == "rotated_second_order_cone") return of_rotated_cone(x, v);
  if (name == "simplex") return of_simplex(a.number("total"), x, v);
  if (name == "capped_simplex") return of_capped_simplex(a.number("total"), a.number("cap"), x, v);
  if (name == "ball1") return of_ball1(a.number("radius"), x, v);
  if (name == "norm_inf") return turned(of_ball1(a.number("weight"), v, x));
  if (name == "max") return turned(of_simplex(interval_at(1), v, x));
  if (name == "sum_largest") return turned(of_capped_simplex(a.number("k"), interval_at(1), v, x));
  if (name == "halfspace") return of_halfspace(a.vector("a"), a.number("b"), false, x, v);
  if (name == "hyperplane") return of_halfspace(a.vector("a"), a.number("b"), true, x, v);
  if (name == "total_variation") return of_total_variation(a.number("weight"), x, v);
  if (name == "bounded_partial_sums") return of_bounded_partial_sums(a.number("bound"), x, v);
  if (name == "monotone_cone") return of_monotone_cone(x, v);
  if (name == "k_support")
    return of_k_support(static_cast<Index>(a.number("k").low), a.number("weight"), x, v);
  if (name == "largest_entries_ball")
    return indicator_of(
        turned(of_k_support(static_cast<Index>(a.number("k").low), a.number("radius"), v, x)));
  if (name == "log_sum_exp") return of_log_sum_exp(x, v);
  if (name == "quadratic") return of_quadratic(a, x);
  if (name == "affine") return of_affine(a, x, v);
  if (MaybeNear found = of_entries(f, x, v)) return found;
  if (MaybeNear found = of_spectrum(f, x, v)) return found;
  return of_operation(f, W, x, v);
}

}  // namespace convex::near_graphs
