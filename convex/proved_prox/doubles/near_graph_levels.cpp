#include <cmath>

#include "convex/double_double.hpp"
#include "convex/exact/rounding_bounds.hpp"
#include "convex/proved_prox/doubles/near_graph_makers.hpp"

/// Sets whose normals have one level on all entries that are not at a bound.
namespace convex::near_graphs {
namespace {

/// The mean of v over the entries that are counted; 0 of none.
template <class Counted>
double mean_over(const Vector& v, Counted counted) {
  double total = 0;
  Index many = 0;
  for (Index i = 0; i < v.size(); ++i)
    if (counted(i)) total += v[i], ++many;
  return many > 0 ? total / static_cast<double>(many) : 0;
}

double with_sign_of(double of, double size) { return of < 0 ? -size : size; }

}  // namespace

MaybeNear of_simplex(const Interval& total, const Vector& x, const Vector& v) {
  const Vector kept = x.cwiseMax(0);
  if (!(total.low > 0)) return std::nullopt;
  const Interval present = sum(kept);
  if (!(present.low > 0)) return std::nullopt;
  const Interval factor = total / present;
  const double level = mean_over(v, [&](Index i) { return kept[i] > 0; });
  NearGraph made(kept, v);
  for (Index i = 0; i < x.size(); ++i) {
    if (kept[i] > 0) {
      made.set_x(i, factor * interval_at(kept[i]));
      made.v[i] = level;
    } else {
      made.v[i] = std::min(v[i], level);
    }
  }
  return made;
}

MaybeNear of_ball1(const Interval& radius, const Vector& x, const Vector& v) {
  NearGraph made(x, v);
  const Interval size = sum(x.cwiseAbs());
  if (v.isZero(0) && size.high <= radius.low) return made;
  if (!(size.low > 0) || !(radius.low > 0)) {
    // x' = 0 is inside, with no covector but 0 unless the radius is 0.
    if (radius.high > 0) return std::nullopt;
    made.x.setZero();
    return made;
  }
  const Interval factor = radius / size;
  const double level = mean_over(v.cwiseAbs(), [&](Index i) { return x[i] != 0; });
  for (Index i = 0; i < x.size(); ++i) {
    if (x[i] != 0) {
      made.set_x(i, factor * interval_at(x[i]));
      made.v[i] = with_sign_of(x[i], level);
    } else {
      made.v[i] = std::clamp(v[i], -level, level);
    }
  }
  return made;
}

MaybeNear of_capped_simplex(const Interval& total, const Interval& cap, const Vector& x, const Vector& v) {
  // What is within a few roundings of the cap counts as there.
  const double near_cap = moved_down(cap.low, 16);
  const auto is_free = [&](Index i) { return x[i] > 0 && x[i] < near_cap; };
  Index many = 0;
  Interval left = total;
  double at_cap = 0, most_at_zero = -INFINITY, least_at_cap = INFINITY;
  for (Index i = 0; i < x.size(); ++i) {
    if (is_free(i)) {
      ++many;
      left = left - interval_at(x[i]);
    } else if (x[i] > 0) {
      left = left - cap;
      at_cap += 1;
      least_at_cap = std::min(least_at_cap, v[i]);
    } else {
      most_at_zero = std::max(most_at_zero, v[i]);
    }
  }
  NearGraph made(x, v);
  double level = mean_over(v, is_free);
  Interval step;
  if (many > 0) {
    step = left / interval_at(static_cast<double>(many));
  } else {
    const DoubleDouble full = two_product(at_cap, cap.low);
    const bool is_exact = total.low == total.high && cap.low == cap.high;
    if (!is_exact || full.hi != total.low || full.lo != 0) return std::nullopt;
    level = std::clamp(0.0, std::min(most_at_zero, least_at_cap), std::max(most_at_zero, least_at_cap));
  }
  for (Index i = 0; i < x.size(); ++i) {
    if (is_free(i)) {
      const Interval moved = interval_at(x[i]) + step;
      if (!(moved.low >= 0 && moved.high <= cap.low)) return std::nullopt;
      made.set_x(i, moved);
      made.v[i] = level;
    } else if (x[i] > 0) {
      made.set_x(i, cap);
      made.v[i] = std::max(v[i], level);
    } else {
      made.x[i] = 0;
      made.v[i] = std::min(v[i], level);
    }
  }
  return made;
}

MaybeNear of_halfspace(const std::vector<Interval>& a, const Interval& b, bool two_sided, const Vector& x,
                       const Vector& v) {
  NearGraph made(x, v);
  Vector normal(x.size());
  Interval value, square_of_a;
  double spread = 0;
  for (Index i = 0; i < x.size(); ++i) {
    const Interval& entry = a[static_cast<std::size_t>(i)];
    normal[i] = middle(entry);
    spread += (entry.high - entry.low) * std::abs(x[i]);
    square_of_a = square_of_a + square(entry);
  }
  value = product_sum(normal, x);
  value = {moved_down(value.low - above(spread)), moved_up(value.high + above(spread))};
  if (!two_sided && v.isZero(0) && value.high <= b.low) return made;
  if (!(square_of_a.low > 0)) return std::nullopt;
  const Interval step = (b - value) / square_of_a;
  double mu = normal.dot(v) / normal.squaredNorm();
  if (!two_sided) mu = std::max(mu, 0.0);
  for (Index i = 0; i < x.size(); ++i) {
    const Interval& entry = a[static_cast<std::size_t>(i)];
    made.set_x(i, interval_at(x[i]) + step * entry);
    made.set_v(i, interval_at(mu) * entry);
  }
  return made;
}

namespace {

/// v'_i = u_(i-1) - u_i for u_0 = u_n = 0.
void put_differences(const std::vector<Interval>& u, NearGraph& made) {
  Interval before;
  for (Index i = 0; i < made.v.size(); ++i) {
    const Interval after = i + 1 < made.v.size() ? u[static_cast<std::size_t>(i)] : Interval{};
    made.set_v(i, before - after);
    before = after;
  }
}

}  // namespace

NearGraph of_total_variation(const Interval& weight, const Vector& x, const Vector& v) {
  NearGraph made(x, v);
  std::vector<Interval> u(static_cast<std::size_t>(x.size()));
  double flow = 0;
  for (Index i = 0; i + 1 < x.size(); ++i) {
    flow -= v[i];
    const double rise = x[i + 1] - x[i];
    u[static_cast<std::size_t>(i)] = rise > 0   ? weight
                                     : rise < 0 ? -weight
                                                : interval_at(std::clamp(flow, -weight.low, weight.low));
    made.f_x =
        made.f_x + weight * (interval_at(std::max(x[i], x[i + 1])) - interval_at(std::min(x[i], x[i + 1])));
  }
  put_differences(u, made);
  return made;
}

NearGraph of_monotone_cone(const Vector& x, const Vector& v) {
  NearGraph made(x, v);
  std::vector<Interval> u(static_cast<std::size_t>(x.size()));
  double flow = 0;
  for (Index i = 0; i < x.size(); ++i) {
    if (i > 0) made.x[i] = std::max(made.x[i], made.x[i - 1]);
    if (i + 1 == x.size()) break;
    flow -= v[i];
    // v = Dᵀu with u <= 0, and 0 where x rises.
    if (std::max(x[i + 1], made.x[i]) <= made.x[i])
      u[static_cast<std::size_t>(i)] = interval_at(std::min(flow, 0.0));
  }
  put_differences(u, made);
  return made;
}

MaybeNear of_bounded_partial_sums(const Interval& bound, const Vector& x, const Vector& v) {
  // The level of v is constant between partial sums at the bound, and rises where they are -bound, for the
  // sums are -u. What is within a few roundings of the bound counts as there.
  const Index n = x.size();
  if (n == 0 || !(bound.low > 0)) return std::nullopt;
  const double near_bound = bound.low * (1 - 64 * unit_roundoff * static_cast<double>(n));
  NearGraph made(x, v);
  std::vector<Interval> u(static_cast<std::size_t>(n));
  double flow = 0, level = 0;
  Index first = 0;
  double sign_before = 0;
  for (Index i = 0; i < n; ++i) {
    flow -= x[i];
    const bool at_end = i + 1 == n;
    const double sign = at_end || std::abs(flow) < near_bound ? 0 : (flow > 0 ? 1.0 : -1.0);
    u[static_cast<std::size_t>(i)] = sign > 0   ? bound
                                     : sign < 0 ? -bound
                                                : interval_at(std::clamp(flow, -bound.low, bound.low));
    if (sign == 0 && !at_end) continue;
    const double mean = v.segment(first, i + 1 - first).mean();
    if (sign_before > 0 && mean < level) return std::nullopt;
    if (sign_before < 0 && mean > level) return std::nullopt;
    level = mean;
    made.v.segment(first, i + 1 - first).setConstant(level);
    first = i + 1;
    sign_before = sign;
  }
  std::swap(made.v, made.x);
  put_differences(u, made);
  std::swap(made.v, made.x);
  std::swap(made.v_radius, made.x_radius);
  return made;
}

}  // namespace convex::near_graphs
