#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/proved_prox/doubles/metric_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"

namespace convex::near_graphs {

namespace {

/// x with f'(x) = p or, where p is only approached by slopes, p - tau x for a tiny tau.
Vector point_of_slope(const Function& f, const Vector& p) {
  if (auto attained = f.conjugate().subgradient(p); attained && attained->allFinite()) return *attained;
  constexpr double tau = 0x1p-60;
  return f.prox(p / tau, Metric::identity(p.size()).scaled(tau)).x;
}

}  // namespace

/// s f(x/s) at s > 0: covectors (p, -f*(p)), p of f at x/s. At (0, 0) all (p, t) with f*(p) <= -t.
MaybeNear of_perspective(const Call& inner, const Vector& x, const Vector& v) {
  const Index n = x.size() - 1;
  const double s = x[n];
  const Metric plain = Metric::identity(n);
  const bool at_apex = x.isZero(0);
  if (!(s > 0) && !at_apex) return std::nullopt;
  const Vector covector = v.head(n);
  Vector point = Vector::Zero(n);
  if (!at_apex) {
    point = x.head(n) / s;
  } else {
    point = point_of_slope(make_function(inner, {plain}), covector);
    if (point.size() != n || !point.allFinite()) return std::nullopt;
  }
  const MaybeNear part = near_graph(inner, plain, point, covector);
  if (!part || part->gap > 0 || part->x_ball > 0) return std::nullopt;
  const Interval dual = inner_product(*part) - part->f_x;
  NearGraph made(x, v);
  made.v.head(n) = part->v;
  made.v_radius.head(n) = part->v_radius;
  made.v_ball = part->v_ball;
  if (at_apex) {
    made.v[n] = std::min(v[n], -dual.high);
    return made;
  }
  for (Index i = 0; i < n; ++i) made.set_x(i, interval_at(s) * part->x_at(i));
  made.set_v(n, -dual);
  made.f_x = interval_at(s) * part->f_x;
  return made;
}

/// {(x, t) : f(x) <= t}: 0 inside, and mu (p, -1) at (x, f(x)), p of f at x.
MaybeNear of_epigraph(const Call& inner, const Vector& x, const Vector& v) {
  const Index n = x.size() - 1;
  const double mu = -v[n];
  const Metric plain = Metric::identity(n);
  const Vector point = x.head(n);
  NearGraph made(x, v);
  if (v.isZero(0)) {
    const auto slope = make_function(inner, {plain}).subgradient(point);
    const MaybeNear part = near_graph(inner, plain, point, slope ? *slope : Vector::Zero(n));
    if (!part || !(part->f_x.high <= x[n])) return std::nullopt;
    made.x.head(n) = part->x;
    made.x_radius.head(n) = part->x_radius;
    made.x_ball = part->x_ball;
    return made;
  }
  if (!(mu > 0)) return std::nullopt;
  const MaybeNear part = near_graph(inner, plain, point, v.head(n) / mu);
  if (!part || part->gap > 0) return std::nullopt;
  made.x.head(n) = part->x;
  made.x_radius.head(n) = part->x_radius;
  made.x_ball = part->x_ball;
  made.set_x(n, part->f_x);
  for (Index i = 0; i < n; ++i) made.set_v(i, interval_at(mu) * part->v_at(i));
  made.v_ball = moved_up(mu * part->v_ball);
  return made;
}

/// weight p + (1 - weight) q for the proxes p and q of gamma f and gamma g in W at one point s: x', and
/// W(s - x')/gamma (Bauschke, Goebel, Lucet and Wang 2008). Pairs of f and g belong to points s that differ
/// by roundings; the prox of gamma g at the other's is no further from q, in W, than these are apart.
MaybeNear of_proximal_average(const IntervalArguments& a, const Metric& W, const Vector& x, const Vector& v) {
  const Interval weight = a.number("weight"), gamma_ = a.number("gamma");
  const double step = middle(gamma_);
  if (weight.low != weight.high || gamma_.low != gamma_.high) return std::nullopt;
  const MetricBounds bounds(W, unit_roundoff);
  if (!bounds.is_proved_definite()) return std::nullopt;
  const Vector s = x + step * W.solve(v);
  const Metric V = W.scaled(1 / step);
  std::vector<NearGraph> parts;
  for (const char* name : {"f", "g"}) {
    const Prox at = make_function(a.call(name), {W}).prox(s, V);
    if (at.x.size() != x.size() || !at.x.allFinite()) return std::nullopt;
    MaybeNear part = near_graph(a.call(name), W, at.x, V.multiply(s - at.x));
    if (!part || part->gap > 0 || part->x_ball > 0 || part->v_ball > 0) return std::nullopt;
    parts.push_back(std::move(*part));
  }
  const NearGraph &f = parts[0], &g = parts[1];
  const Interval rest = interval_at(1) - weight;
  NearGraph made(x, v), between(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    between.set_x(i, f.x_at(i) - g.x_at(i));
    made.set_x(i, weight * f.x_at(i) + rest * g.x_at(i));
  }
  const double distance = bounds.norm_above(between.x, between.x_radius);
  NearGraph moved = between;  // x: W(p - q)
  bounds.multiply(moved.x, moved.x_radius);
  Interval square_between;
  for (Index i = 0; i < x.size(); ++i) {
    square_between = square_between + between.x_at(i) * moved.x_at(i);
    made.set_v(i, rest * moved.x_at(i) / gamma_ + f.v_at(i));
    moved.set_v(i, moved.x_at(i) + gamma_ * (f.v_at(i) - g.v_at(i)));
  }
  const double apart = bounds.dual_norm_above(moved.v, moved.v_radius);
  if (!std::isfinite(apart)) return std::nullopt;
  made.x_ball = bounds.dual_norm_above(above(rest.high * apart));  // |e|₂ <= ||e||_W / sqrt(least)
  made.v_ball = bounds.norm_above(above(rest.high * apart / gamma_.low));
  // g at the other's prox: between its slopes there and here.
  const double slope = above(bounds.dual_norm_above(g.v, g.v_radius) + above(apart / gamma_.low));
  const double of_g = above(slope * apart), of_square = above(apart * (2 * distance + apart));
  square_between = {std::max(0.0, moved_down(square_between.low - of_square)),
                    moved_up(square_between.high + of_square)};
  made.f_x = weight * f.f_x + rest * Interval{moved_down(g.f_x.low - of_g), moved_up(g.f_x.high + of_g)} +
             weight * rest * square_between / (interval_at(2) * gamma_);
  return made;
}

}  // namespace convex::near_graphs
