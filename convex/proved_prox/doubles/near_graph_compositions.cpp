#include <cmath>

#include "convex/catalogue/catalogue.hpp"
#include "convex/nearest_point/proof/rounding_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"

namespace convex::near_graphs {

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
  } else if (const auto slope = make_function(inner, {plain}).conjugate().subgradient(covector)) {
    point = *slope;
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
    const MaybeNear part = near_graph(inner, plain, point, Vector::Zero(n));
    if (!part || part->x != point || !part->x_radius.isZero(0) || part->x_ball > 0 || part->f_x.high > x[n])
      return std::nullopt;
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

/// weight p + (1 - weight) q for the proxes p and q of gamma f and gamma g at one point s: x' and (s -
/// x')/gamma (Bauschke, Goebel, Lucet and Wang 2008). Pairs of f and g belong to sums s that differ by
/// roundings; the prox of gamma g at the other's is no further from q than these are apart.
MaybeNear of_proximal_average(const IntervalArguments& a, const Metric& W, const Vector& x, const Vector& v) {
  const Interval weight = a.number("weight"), gamma_ = a.number("gamma");
  const double step = middle(gamma_);
  if (weight.low != weight.high || gamma_.low != gamma_.high || W.kind() != MetricKind::identity)
    return std::nullopt;
  const Vector s = x + step * v;
  const Metric V = W.scaled(1 / step);
  std::vector<NearGraph> parts;
  for (const char* name : {"f", "g"}) {
    const Prox at = make_function(a.call(name), {W}).prox(s, V);
    if (at.x.size() != x.size() || !at.x.allFinite()) return std::nullopt;
    MaybeNear part = near_graph(a.call(name), W, at.x, (s - at.x) / step);
    if (!part || part->gap > 0 || part->x_ball > 0 || part->v_ball > 0) return std::nullopt;
    parts.push_back(std::move(*part));
  }
  const NearGraph &f = parts[0], &g = parts[1];
  double apart = 0, distance = 0;
  const Interval rest = interval_at(1) - weight;
  NearGraph made(x, v);
  for (Index i = 0; i < x.size(); ++i) {
    const Interval between = f.x_at(i) - g.x_at(i);
    const double off = largest_size(between + gamma_ * (f.v_at(i) - g.v_at(i)));
    apart += off * off;
    distance += largest_size(square(between));
    made.set_x(i, weight * f.x_at(i) + rest * g.x_at(i));
    made.set_v(i, rest * between / gamma_ + f.v_at(i));
  }
  apart = above(std::sqrt(above(apart)));
  made.x_ball = above(rest.high * apart);
  made.v_ball = above(made.x_ball / gamma_.low);
  // g at the other's prox: between its slopes there and here.
  const double slope = above(above((g.v.cwiseAbs() + g.v_radius).norm()) + above(apart / gamma_.low));
  const double of_g = above(slope * apart), root_of_distance = above(std::sqrt(above(distance)));
  const double of_square = above(apart * (2 * root_of_distance + apart));
  Interval square_between;
  for (Index i = 0; i < x.size(); ++i) square_between = square_between + square(f.x_at(i) - g.x_at(i));
  square_between = {std::max(0.0, moved_down(square_between.low - of_square)),
                    moved_up(square_between.high + of_square)};
  made.f_x = weight * f.f_x + rest * Interval{moved_down(g.f_x.low - of_g), moved_up(g.f_x.high + of_g)} +
             weight * rest * square_between / (interval_at(2) * gamma_);
  return made;
}

}  // namespace convex::near_graphs
