#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"

namespace convex::near_graphs {
namespace {

/// Squares of what is in here neither overflow nor lose digits to underflow; 0 may stand with them.
bool has_ordinary_norm(const Vector& x) {
  const double largest = x.cwiseAbs().maxCoeff();
  return largest <= largest_ordinary && largest >= smallest_ordinary;
}

/// c x for an interval c, into centre and radius.
void put_multiple(const Interval& c, const Vector& x, Vector& centre, Vector& radius) {
  const double m = middle(c),
               half = moved_up(std::max(c.high - m, m - c.low) + unit_roundoff * std::abs(m), 2);
  centre = m * x;
  radius = (half * x.cwiseAbs()).array() * (1 + 4 * unit_roundoff) + 1e-320;
}

/// For p < 2 the slope (|x_i|/|x|_p)^(p-1) is steep at 0, so that a rounding of x_i is much of v_i: there
/// v_i says which x_i it belongs to.
void steepen_small_entries(double p, const Interval& weight, const Vector& x, const Vector& v,
                           Vector& point) {
  constexpr double small_part = 1e-8, least_part = 1e-200;
  const double largest = x.cwiseAbs().maxCoeff();
  const double length = largest * std::pow((x.cwiseAbs() / largest).array().pow(p).sum(), 1 / p);
  for (Index i = 0; i < x.size(); ++i) {
    if (std::abs(x[i]) > small_part * largest) continue;
    const double part = std::pow(std::abs(v[i]) / middle(weight), 1 / (p - 1));
    point[i] = part > least_part && part < 1 ? std::copysign(length * part, v[i]) : 0;
  }
}

}  // namespace

NearGraph of_norm2(const Interval& weight, const Vector& x, const Vector& v) {
  NearGraph made(x, v);
  if (x.size() > 0 && has_ordinary_norm(x)) {
    const Interval length = root(square_sum(x));
    put_multiple(weight / length, x, made.v, made.v_radius);
    made.f_x = weight * length;
    return made;
  }
  made.x.setZero();
  const double size = root(square_sum(v)).high;
  if (size > weight.low) made.v *= moved_down(weight.low / size, 8);
  return made;
}

MaybeNear of_norm_p(double p, const Interval& weight, const Vector& x, const Vector& v) {
  if (x.isZero(0)) {
    // Σ (|v_i|/weight)^q <= 1; powers of what is below 1 are larger for a smaller exponent.
    NearGraph made(x, v);
    const double q = moved_down(p / (p - 1), 4);
    double sum = 0;
    for (const double entry : v) {
      const double part = moved_up(std::abs(entry) / weight.low, 2);
      if (part > 1) return std::nullopt;
      sum = moved_up(
          sum + (part < smallest_ordinary ? smallest_ordinary : moved_up(std::pow(part, q), library_units)));
    }
    if (!(sum <= 1)) return std::nullopt;
    return made;
  }
  if (!has_ordinary_norm(x)) return std::nullopt;
  NearGraph made(x, v);
  const double largest = x.cwiseAbs().maxCoeff();
  if (p < 2) steepen_small_entries(p, weight, x, v, made.x);
  const auto power = [&](double a, double e) {
    const double value = a == 0 ? 0 : std::pow(a, e);
    return outwards(value, value, library_units);
  };
  Interval sum_of_powers;
  for (const double entry : made.x) sum_of_powers = sum_of_powers + power(std::abs(entry) / largest, p);
  // Quotients are rounded once more, which p multiplies.
  const int units = 4 + static_cast<int>(std::ceil(p));
  sum_of_powers = outwards(sum_of_powers.low, sum_of_powers.high, units);
  const auto power_of = [&](const Interval& a, double e) {
    const double from = std::pow(a.low, e), to = std::pow(a.high, e);
    return outwards(std::min(from, to), std::max(from, to), library_units + 2);
  };
  // (Σ t^p)^(1/p), t = |x|/largest; v_i = weight (t_i)^(p-1) / (Σ t^p)^((p-1)/p).
  made.f_x = weight * interval_at(largest) * power_of(sum_of_powers, 1 / p);
  const Interval scale = weight / power_of(sum_of_powers, (p - 1) / p);
  for (Index i = 0; i < x.size(); ++i) {
    const Interval t = power(std::abs(made.x[i]) / largest, p - 1);
    const Interval size = scale * outwards(t.low, t.high, units);
    made.set_v(i, made.x[i] < 0 ? -size : size);
  }
  return made;
}

MaybeNear of_k_support(Index k, const Interval& weight, const Vector& x, const Vector& v) {
  const Index n = x.size();
  NearGraph made(x, v);
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), Index{0});
  const auto sorted_by = [&](const Vector& sizes) {
    std::stable_sort(order.begin(), order.end(),
                     [&](Index i, Index j) { return std::abs(sizes[i]) > std::abs(sizes[j]); });
    Vector values(n);
    for (Index i = 0; i < n; ++i) values[i] = std::abs(sizes[order[static_cast<std::size_t>(i)]]);
    return values;
  };
  if (x.isZero(0)) {
    const double size = root(square_sum(Vector(sorted_by(v).head(k)))).high;
    if (size > weight.low) made.v *= moved_down(weight.low / size, 8);
    return made;
  }
  if (!has_ordinary_norm(x)) return std::nullopt;
  // x_(k-r-1) > level >= x_(k-r), counted from 1, x_(0) infinite: surely, or with equality.
  const Vector sizes = sorted_by(x);
  Index many = k - 1;
  Interval level;
  for (;; --many) {
    level = sum(Vector(sizes.tail(n - many)));
    if (k - many > 1) level = level / interval_at(static_cast<double>(k - many));
    // A sum of sizes is at least its first one.
    const bool above_next = level.low >= sizes[many] || k - many == 1;
    if (above_next && (many == 0 || sizes[many - 1] >= level.high)) break;
    if (many == 0) return std::nullopt;
  }
  const Vector top = sizes.head(many);
  made.f_x = weight * root(square_sum(top) + interval_at(static_cast<double>(k - many)) * square(level));
  const Interval factor = weight * weight / made.f_x, tail = factor * level;
  for (Index i = 0; i < n; ++i) {
    const Index at = order[static_cast<std::size_t>(i)];
    if (i < many)
      made.set_v(at, factor * interval_at(x[at]));
    else if (x[at] != 0)
      made.set_v(at, x[at] < 0 ? -tail : tail);
    else
      made.v[at] = std::clamp(v[at], -tail.low, tail.low);
  }
  return made;
}

MaybeNear of_log_sum_exp(const Vector& x, const Vector&) {
  NearGraph made(x, x);
  const double largest = x.maxCoeff();
  std::vector<Interval> parts;
  Interval total;
  for (const double entry : x) {
    const Interval difference = interval_at(entry) - interval_at(largest);
    parts.push_back(increasing([](double t) { return std::exp(t); }, difference));
    total = total + parts.back();
  }
  for (Index i = 0; i < x.size(); ++i) made.set_v(i, parts[static_cast<std::size_t>(i)] / total);
  made.f_x = interval_at(largest) + increasing([](double t) { return std::log(t); }, total);
  return made;
}

MaybeNear of_second_order_cone(const Vector& x, const Vector& v) {
  const Index n = x.size();
  if (n < 2) return std::nullopt;
  NearGraph made(x, v);
  const Vector a = x.head(n - 1), b = v.head(n - 1);
  const double t = x[n - 1];
  if (v.isZero(0) && root(square_sum(a)).high <= t) return made;
  if (x.isZero(0) && root(square_sum(b)).high <= -v[n - 1]) return made;
  const double mu = -v[n - 1];
  if (!(mu > 0) || !has_ordinary_norm(a)) return std::nullopt;
  const Interval length = root(square_sum(a));
  made.set_x(n - 1, length);
  Vector centre, radius;
  put_multiple(interval_at(mu) / length, a, centre, radius);
  made.v.head(n - 1) = centre;
  made.v_radius.head(n - 1) = radius;
  return made;
}

MaybeNear of_rotated_cone(const Vector& x, const Vector& v) {
  const Index n = x.size();
  if (n < 3) return std::nullopt;
  NearGraph made(x, v);
  const Vector a = x.head(n - 2);
  const double s = x[n - 2], t = x[n - 1];
  const Interval square_of_a = square_sum(a);
  if (v.isZero(0) && s >= 0 && t >= 0 && square_of_a.high <= moved_down(2 * s * t, 4)) return made;
  if (x.isZero(0) && v[n - 2] <= 0 && v[n - 1] <= 0 &&
      square_sum(v.head(n - 2)).high <= moved_down(2 * v[n - 2] * v[n - 1], 4))
    return made;
  // |a|² = 2 s t: the larger of s and t stands, and normals are multiples mu (a, -t, -s).
  const Index large = s >= t ? n - 2 : n - 1, small = s >= t ? n - 1 : n - 2;
  if (!(x[large] > 0)) return std::nullopt;
  const Interval other = square_of_a / interval_at(2 * x[large]);
  const Interval mu = interval_at(-v[small]) / interval_at(x[large]);
  if (!(mu.low >= 0)) return std::nullopt;
  made.set_x(small, other);
  made.v[small] = v[small];
  made.set_v(large, -(mu * other));
  Vector centre, radius;
  put_multiple(mu, a, centre, radius);
  made.v.head(n - 2) = centre;
  made.v_radius.head(n - 2) = radius;
  return made;
}

}  // namespace convex::near_graphs
