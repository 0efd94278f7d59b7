#include <cmath>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"

namespace convex::near_graphs {

/// x' + by, with by in intervals.
void move_by(Vector& centre, Vector& radius, const std::vector<Interval>& by) {
  for (Index i = 0; i < centre.size(); ++i) {
    const Interval moved =
        Interval{centre[i] - radius[i], centre[i] + radius[i]} + by[static_cast<std::size_t>(i)];
    // Ends of a centre and its radius are rounded once more.
    const double rounded = moved_up(std::abs(centre[i]) + radius[i]) * unit_roundoff;
    centre[i] = middle(moved);
    radius[i] = moved_up(std::max(moved.high - centre[i], centre[i] - moved.low) + rounded);
  }
}

Vector middles(const std::vector<Interval>& a) {
  Vector made(static_cast<Index>(a.size()));
  for (std::size_t i = 0; i < a.size(); ++i) made[static_cast<Index>(i)] = middle(a[i]);
  return made;
}

namespace {

MaybeNear turned_or_none(MaybeNear pair) {
  if (!pair) return pair;
  return turned_round(std::move(*pair));
}

void multiply_by(Vector& centre, Vector& radius, double& ball, const Interval& factor) {
  const double size = largest_size(factor), half = 0.5 * (factor.high - factor.low);
  const double m = middle(factor);
  for (Index i = 0; i < centre.size(); ++i) {
    const double c = m * centre[i];
    radius[i] = moved_up(size * radius[i] + (half + 4 * unit_roundoff * size) * std::abs(centre[i]), 4);
    centre[i] = c;
  }
  ball = moved_up(ball * size);
}

/// Σ by_i v'_i.
Interval inner_with(const std::vector<Interval>& by, const Vector& centre, const Vector& radius,
                    double ball) {
  Interval total;
  double square = 0;
  for (Index i = 0; i < centre.size(); ++i) {
    const Interval& b = by[static_cast<std::size_t>(i)];
    total = total + b * outwards(centre[i] - radius[i], centre[i] + radius[i]);
    square += largest_size(b) * largest_size(b);
  }
  const double more = above(ball * std::sqrt(above(square)));
  return {moved_down(total.low - more), moved_up(total.high + more)};
}

MaybeNear of_blocks(const Call& f, const Metric& W, const Vector& x, const Vector& v) {
  if (W.kind() != MetricKind::identity && W.kind() != MetricKind::diagonal) return std::nullopt;
  NearGraph whole(x.size());
  Index first = 0;
  double x_square = 0, v_square = 0;
  for (std::size_t k = 0; k + 1 < f.arguments.size(); k += 2) {
    const auto n = static_cast<Index>(std::get<double>(f.arguments[k + 1].value));
    const Call& part_call = *std::get<std::shared_ptr<const Call>>(f.arguments[k].value);
    const Metric part_metric = W.kind() == MetricKind::identity
                                   ? Metric::identity(n)
                                   : Metric::diagonal(W.diagonal().segment(first, n));
    const MaybeNear part = near_graph(part_call, part_metric, x.segment(first, n), v.segment(first, n));
    if (!part) return std::nullopt;
    whole.x.segment(first, n) = part->x;
    whole.x_radius.segment(first, n) = part->x_radius;
    whole.v.segment(first, n) = part->v;
    whole.v_radius.segment(first, n) = part->v_radius;
    x_square += part->x_ball * part->x_ball;
    v_square += part->v_ball * part->v_ball;
    whole.gap = moved_up(whole.gap + part->gap);
    whole.f_x = whole.f_x + part->f_x;
    first += n;
  }
  whole.x_ball = above(std::sqrt(x_square));
  whole.v_ball = above(std::sqrt(v_square));
  return whole;
}

/// γ ½ ||v||² and x further by γ W⁻¹v, W = 1 or a diagonal (Moreau 1965), whose entries may be rounded.
MaybeNear of_envelope(const Call& part, const Metric& inside, const Interval& gamma_, const Metric& W,
                      const Vector& x, const Vector& v) {
  if (W.kind() != MetricKind::identity && W.kind() != MetricKind::diagonal) return std::nullopt;
  const Vector& d = W.diagonal();
  MaybeNear found = near_graph(part, inside, x - middle(gamma_) * v.cwiseQuotient(d), v);
  if (!found) return found;
  Interval half;
  double size = 0;
  for (Index i = 0; i < x.size(); ++i) {
    const Interval slope = found->v_at(i);
    const Interval step = gamma_ * slope / outwards(d[i], d[i]);
    found->set_x(i, found->x_at(i) + step);
    half = half + gamma_ * square(slope) / outwards(2 * d[i], 2 * d[i]);
    size += largest_size(square(slope));
  }
  if (found->v_ball > 0) {  // |W⁻¹e| <= |e|/least and |(v + e)² - v²| <= |e| (2|v| + |e|), in all entries
    const double most_step = above(gamma_.high / d.minCoeff()), off = found->v_ball;
    found->x_ball = above(found->x_ball + most_step * off);
    const double more = above(most_step * off * above(std::sqrt(above(size)) + 0.5 * off));
    half = {moved_down(half.low - more), moved_up(half.high + more)};
  }
  found->f_x = found->f_x + half;
  return found;
}

/// h(y) = f*(Wy), W = 1 or a diagonal: f at W⁻¹v and the covector Wy.
MaybeNear of_conjugate(const Call& part, const Metric& W, const Vector& y, const Vector& v) {
  if (W.kind() == MetricKind::identity) return turned_or_none(near_graph(part, W, v, y));
  if (W.kind() != MetricKind::diagonal) return std::nullopt;
  const Vector& d = W.diagonal();
  MaybeNear found = near_graph(part, W, v.cwiseQuotient(d), y.cwiseProduct(d));
  if (!found) return found;
  NearGraph made = turned_round(std::move(*found));
  for (Index i = 0; i < y.size(); ++i) {
    const Interval w = outwards(d[i], d[i]);
    made.set_x(i, made.x_at(i) / w);
    made.set_v(i, made.v_at(i) * w);
  }
  made.x_ball = above(made.x_ball / d.minCoeff());
  made.v_ball = above(made.v_ball * d.maxCoeff());
  return made;
}

}  // namespace

MaybeNear of_operation(const Call& f, const Metric& W, const Vector& x, const Vector& v) {
  const IntervalArguments a(f, x.size());
  const std::string& name = f.name;
  if (name == "separable") return of_blocks(f, W, x, v);
  if (name == "perspective") return of_perspective(a.call("f"), x, v);
  if (name == "epigraph") return of_epigraph(a.call("f"), x, v);
  if (name == "proximal_average") return of_proximal_average(a, W, x, v);
  if (name == "conjugate") return of_conjugate(a.call("f"), W, x, v);
  if (name == "support") return of_conjugate(a.call("set"), W, x, v);
  if (name == "envelope") return of_envelope(a.call("f"), W, a.number("gamma"), W, x, v);
  if (name == "squared_distance") {
    const Interval weight = a.number("weight");
    if (!(weight.low > 0)) return std::nullopt;
    return of_envelope(a.call("set"), W, interval_at(1) / weight, Metric::identity(x.size()), x, v);
  }
  if (name == "translate") {
    const std::vector<Interval> by = a.vector("by");
    MaybeNear found = near_graph(a.call("f"), W, x - middles(by), v);
    if (found) move_by(found->x, found->x_radius, by);
    return found;
  }
  if (name == "tilt") {
    const std::vector<Interval> c = a.vector("c");
    MaybeNear found = near_graph(a.call("f"), W, x, v - middles(c));
    if (!found) return found;
    found->f_x = found->f_x + inner_with(c, found->x, found->x_radius, found->x_ball);
    move_by(found->v, found->v_radius, c);
    return found;
  }
  if (name == "scale") {
    const Interval alpha = a.number("alpha");
    MaybeNear found = near_graph(a.call("f"), W, x, v / middle(alpha));
    if (!found) return found;
    multiply_by(found->v, found->v_radius, found->v_ball, alpha);
    found->f_x = alpha * found->f_x;
    found->gap = moved_up(found->gap * alpha.high);
    return found;
  }
  if (name == "dilate") {
    const Interval rho = a.number("rho");
    MaybeNear found = near_graph(a.call("f"), W, x / middle(rho), v * middle(rho));
    if (!found) return found;
    multiply_by(found->x, found->x_radius, found->x_ball, rho);
    multiply_by(found->v, found->v_radius, found->v_ball, interval_at(1) / rho);
    return found;
  }
  return std::nullopt;
}

}  // namespace convex::near_graphs
