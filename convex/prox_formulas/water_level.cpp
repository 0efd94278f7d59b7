#include "convex/prox_formulas/water_level.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "convex/double_double.hpp"

namespace convex::prox_formulas {

namespace {

/// A number whose terms cancel, summed in twice the working precision.
struct Sum {
  DoubleDouble value;
  void operator+=(double term) {
    const DoubleDouble s = two_sum(value.hi, term);
    value = {s.hi, value.lo + s.lo};
  }
  double rounded() const { return value.value(); }
};

struct Item {
  double full, none;  // cap up to `full`, zero from `none` on
  double slope;
};

/// The level without a cap: any set S of terms gives (Σ_S slope point - total)/Σ_S slope <= level, so what
/// lies below that can be dropped, again and again (Michelot 1986). Points are measured from the largest.
double uncapped_level(const Vector& point, const Vector& slope, double total) {
  Index highest = 0;
  const double top = point.maxCoeff(&highest);
  const auto n = static_cast<std::size_t>(point.size());
  std::vector<double> below(n), weight(n);
  double bound = -total / slope[highest], moment = 0, weights = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Index>(i);
    const double b = point[k] - top;
    const bool above = b > bound;  // a coin's toss, so no branch
    below[count] = b;
    weight[count] = slope[k];
    count += above;
    moment += above ? slope[k] * b : 0;
    weights += above ? slope[k] : 0;
    constexpr std::size_t block = 256;  // terms between two divisions
    if (i % block == block - 1 && count > 0) bound = std::max(bound, (moment - total) / weights);
  }
  for (std::size_t last = n + 1; count > 0 && count < last;) {
    bound = std::max(bound, (moment - total) / weights);
    last = count;
    count = 0;
    moment = weights = 0;
    for (std::size_t i = 0; i < last; ++i) {
      const double b = below[i], w = weight[i];
      const bool above = b > bound;
      below[count] = b;
      weight[count] = w;
      count += above;
      moment += above ? w * b : 0;
      weights += above ? w : 0;
    }
  }
  if (count == 0) return top + bound;  // total is so small that its share underflows
  Sum exact;
  exact += -total;
  for (std::size_t i = 0; i < count; ++i) exact += weight[i] * below[i];
  return top + exact.rounded() / weights;
}

}  // namespace

double water_level(const Vector& point, const Vector& slope, double cap, double total) {
  if (!(cap < std::numeric_limits<double>::infinity())) return uncapped_level(point, slope, total);
  std::vector<Item> open;
  open.reserve(static_cast<std::size_t>(point.size()));
  for (Index i = 0; i < point.size(); ++i) open.push_back({point[i] - cap / slope[i], point[i], slope[i]});
  double lo = -std::numeric_limits<double>::infinity(), hi = -lo;
  Index capped = 0;        // at cap over the whole bracket
  double slopes = 0;       // of those that are linear over the whole bracket
  double base = 0;         // what their points are measured from: any level in the first bracket
  Sum linear;              // Σ slope (point - base)
  std::uint32_t draw = 1;  // any deterministic sequence that no data is likely to follow
  const auto at = [&](double level) {
    Sum height;
    height += static_cast<double>(capped) * cap;
    height += linear.rounded();
    height += slopes * (base - level);
    for (const Item& item : open)
      if (level < item.none) height += level <= item.full ? cap : item.slope * (item.none - level);
    return height.rounded();
  };
  while (!open.empty()) {
    draw = draw * 1664525U + 1013904223U;
    const Item& chosen = open[static_cast<std::size_t>((std::uint64_t{draw} * open.size()) >> 32)];
    const bool upper = chosen.none > lo && chosen.none < hi && ((draw & 0x8000U) || !(chosen.full > lo));
    const double level = upper                                  ? chosen.none
                         : chosen.full > lo && chosen.full < hi ? chosen.full
                                                                : chosen.none;
    if (slopes <= 0) base = level;
    (at(level) > total ? lo : hi) = level;
    const auto decided = [&](const Item& item) {
      if (item.none <= lo) return true;
      if (item.full >= hi) {
        ++capped;
        return true;
      }
      if (item.full > lo || item.none < hi) return false;
      slopes += item.slope;
      linear += item.slope * (item.none - base);
      return true;
    };
    open.erase(std::remove_if(open.begin(), open.end(), decided), open.end());
  }
  if (!(slopes > 0)) return hi < std::numeric_limits<double>::infinity() ? hi : lo;
  const double missing = linear.rounded() + static_cast<double>(capped) * cap - total;
  return std::clamp(base + missing / slopes, lo, hi);
}

namespace {

/// v_i - level/d_i.
struct OfShares {
  const Vector &v, &d;
  double rough(Index i, double level) const { return v[i] - level / d[i]; }
  double size(Index i, double level) const { return std::abs(v[i]) + std::abs(level / d[i]); }
  DoubleDouble operator()(Index i, DoubleDouble level) const {
    return add(DoubleDouble{v[i], 0}, negative(quotient(level, DoubleDouble{d[i], 0})));
  }
  DoubleDouble slope(Index i) const { return quotient(DoubleDouble{1, 0}, DoubleDouble{d[i], 0}); }
  double breakpoint(Index i, double value) const { return d[i] * (v[i] - value); }
  DoubleDouble level_of(Index i, double value) const {
    return product(add(DoubleDouble{v[i], 0}, DoubleDouble{-value, 0}), d[i]);
  }
};

/// slope_i (point_i - level).
struct OfPoints {
  const Vector &point, &weight;
  double rough(Index i, double level) const { return weight[i] * (point[i] - level); }
  double size(Index i, double level) const { return weight[i] * (std::abs(point[i]) + std::abs(level)); }
  DoubleDouble operator()(Index i, DoubleDouble level) const {
    return product(add(DoubleDouble{point[i], 0}, negative(level)), weight[i]);
  }
  DoubleDouble slope(Index i) const { return {weight[i], 0}; }
  double breakpoint(Index i, double value) const { return point[i] - value / weight[i]; }
  DoubleDouble level_of(Index i, double value) const {
    return add(DoubleDouble{point[i], 0},
               negative(quotient(DoubleDouble{value, 0}, DoubleDouble{weight[i], 0})));
  }
};

/// The terms clamped to [0, cap], the sum of all, and by how much that falls as the level rises.
struct Clamped {
  DoubleDouble level;
  Vector x;
  std::vector<char> piece;  ///< of each: 0 at zero, 1 free, 2 at the cap
  DoubleDouble sum, slope;
};

template <class Terms>
Clamped clamped(const Terms& terms, Index n, double cap, DoubleDouble level) {
  constexpr double near = 1e-8;  // of the parts of a difference that doubles do not tell the sign of
  Clamped found{level, Vector::Zero(n), std::vector<char>(static_cast<std::size_t>(n)), {}, {}};
  RunningSum sum, slope;
  for (Index i = 0; i < n; ++i) {
    const double rough = terms.rough(i, level.hi), margin = near * terms.size(i, level.hi);
    if (rough < -margin || !std::isfinite(margin)) continue;
    const DoubleDouble x = rough > cap + margin ? DoubleDouble{cap, 0} : terms(i, level);
    if (!(x.value() > 0)) continue;
    const bool is_free = std::isinf(cap) || add(x, DoubleDouble{-cap, 0}).value() < 0;
    found.x[i] = std::min(x.value(), cap);
    sum.add(is_free ? x : DoubleDouble{cap, 0});
    found.piece[static_cast<std::size_t>(i)] = is_free ? 1 : 2;
    if (!is_free) continue;
    slope.add(terms.slope(i));
  }
  found.sum = sum.tidy();
  found.slope = slope.tidy();
  return found;
}

/// Where none is free, the level at which the first entry to become so makes up for what is missing, or too
/// much, as far as it can by itself. None where nothing is left to move.
template <class Terms>
std::optional<DoubleDouble> level_of_next(const Terms& terms, const Clamped& at, double cap, double excess) {
  const double fixed = excess > 0 ? cap : 0;
  Index next = -1;
  double best = 0;
  for (Index i = 0; i < at.x.size(); ++i) {
    if (at.x[i] != fixed) continue;
    const double breakpoint = terms.breakpoint(i, fixed);
    if (next >= 0 && !(excess > 0 ? breakpoint < best : breakpoint > best)) continue;
    next = i;
    best = breakpoint;
  }
  if (next < 0) return std::nullopt;
  return terms.level_of(next, excess > 0 ? std::max(0.0, cap - excess) : std::min(cap, -excess));
}

/// Newton's steps on the piecewise linear sum, which end where all stay on their pieces; within the levels
/// between which the total lies, once there are two.
template <class Terms>
Clamped with_total(const Terms& terms, Index n, double cap, double total, double near) {
  constexpr int most_steps = 400;
  constexpr double settled = 0x1p-90;
  Clamped at = clamped(terms, n, cap, {near, 0});
  std::optional<DoubleDouble> low, high;
  for (int step = 0; step < most_steps; ++step) {
    const DoubleDouble excess = add(at.sum, DoubleDouble{-total, 0});
    if (excess.value() == 0) break;
    (excess.value() > 0 ? low : high) = at.level;
    const bool is_free = at.slope.hi > 0;
    std::optional<DoubleDouble> level =
        is_free ? add(at.level, quotient(excess, at.slope)) : level_of_next(terms, at, cap, excess.value());
    const auto is_above = [](const DoubleDouble& x, const DoubleDouble& y) {
      return add(x, negative(y)).value() > 0;
    };
    const bool is_inside = !low || !high || (level && is_above(*level, *low) && is_above(*high, *level));
    if (!is_inside) {
      level = product(add(*low, *high), 0.5);
      if (!is_above(*level, *low) || !is_above(*high, *level)) break;
    }
    if (!level || !std::isfinite(level->hi)) break;
    Clamped next = clamped(terms, n, cap, *level);
    // The first step on a piece may come from far away, with few digits.
    const double left = std::abs(add(next.sum, DoubleDouble{-total, 0}).value());
    const bool is_settled = is_free && is_inside && next.piece == at.piece &&
                            (left <= settled * total || !(left < std::abs(excess.value()) / 2));
    at = std::move(next);
    if (is_settled) break;
  }
  return at;
}

}  // namespace

Vector clamped_to_total(const Vector& v, const Vector& d, double cap, double total) {
  const double near = water_level(v.cwiseProduct(d), d.cwiseInverse(), cap, total);
  return with_total(OfShares{v, d}, v.size(), cap, total, near).x;
}

double exact_water_level(const Vector& point, const Vector& slope, double cap, double total) {
  const double near = water_level(point, slope, cap, total);
  return with_total(OfPoints{point, slope}, point.size(), cap, total, near).level.value();
}

}  // namespace convex::prox_formulas
