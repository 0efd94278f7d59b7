#include "convex/prox_formulas/k_support.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::prox_formulas {
namespace {

/// |z| in decreasing order.
Vector sizes_in_order(const Vector& z) {
  Vector s = z.cwiseAbs();
  std::sort(s.begin(), s.end(), std::greater<>());
  return s;
}

/// The t > 0 with Σ clamp((s_i/t - 1)/mu, 0, 1) = k, for s >= 0 in decreasing order with more than k entries
/// that are not 0: with s_1 … s_top full, s_(top+1) … s_last in between, Σ (s_i - t) = (k - top) mu t.
double level_of_k(const Vector& s, double mu, Index k) {
  const auto count = [&](double t) {
    double sum = 0;
    for (const double size : s) sum += std::clamp((size / t - 1) / mu, 0.0, 1.0);
    return sum;
  };
  // Breakpoints: s_i/(1 + mu), below which an entry is full, and s_i, above which it is empty.
  std::vector<double> breaks;
  for (const double size : s) {
    if (!(size > 0)) continue;
    breaks.push_back(size);
    breaks.push_back(size / (1 + mu));
  }
  std::sort(breaks.begin(), breaks.end());
  std::size_t low = 0, high = breaks.size() - 1;  // count is >= k at low's, and less than k at high's, t
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (count(breaks[middle]) >= static_cast<double>(k) ? low : high) = middle;
  }
  double sum = 0, between = 0, full = 0;
  const double inside = breaks[low] + (breaks[high] - breaks[low]) / 2;
  for (const double size : s) {
    if (size >= inside * (1 + mu)) {
      ++full;
    } else if (size > inside) {
      sum += size;
      ++between;
    }
  }
  if (between == 0) return breaks[low];
  return std::clamp(sum / (between + (static_cast<double>(k) - full) * mu), breaks[low], breaks[high]);
}

Index entries_not_zero(const Vector& s) { return (s.array() > 0).count(); }

double squares_of_largest(const Vector& s, Index k) { return s.head(std::min(k, s.size())).squaredNorm(); }

/// theta_i = clamp(alpha s_i - lambda, 0, 1) with Σ theta = k by t = lambda/alpha, the level above for mu =
/// 1/lambda: alpha s - lambda = lambda (s/t - 1) would cancel where lambda is large, as for z near the ball.
struct Levels {
  double lambda = 0, t = 0;
  bool all_full = false;  ///< at most k entries are not 0: theta = 1 on them

  double alpha() const { return lambda / t; }
  bool is_full(double size) const { return all_full ? size > 0 : size >= t * (1 + 1 / lambda); }
  bool is_between(double size) const { return !all_full && size > t && !is_full(size); }
};

/// The share lambda |x| of the prox, increasing in lambda from 0 to the dual norm of z: where theta is
/// between 0 and 1, theta (s/(theta + lambda))² = theta/alpha², and there the theta add up to k less those
/// full.
double share(const Vector& s, double lambda, Index k, Levels& levels) {
  levels.lambda = lambda;
  levels.all_full = entries_not_zero(s) <= k;
  if (levels.all_full) return lambda / (1 + lambda) * s.stableNorm();
  levels.t = level_of_k(s, 1 / lambda, k);
  double squares = 0, rest = static_cast<double>(k);
  for (const double size : s)
    if (levels.is_full(size)) squares += std::pow(lambda / (1 + lambda) * size, 2), --rest;
  return std::sqrt(squares + std::max(rest, 0.0) * levels.t * levels.t);
}

/// The root of an increasing function on (0, inf) that is 0 at 0 and above `value` far out; by bisection of
/// exponents, then regula falsi with halved ends (Dowell and Jarratt 1971).
template <class Increasing>
double positive_root(const Increasing& f) {
  double low = 0, high = 1;
  while (f(high) < 0) {
    low = high;
    high *= 4;
    if (!(high < 0x1p600)) return high;
  }
  if (low == 0) {
    low = high;
    do {
      high = low;
      low /= 4;
      if (!(low > 0x1p-600)) return low;
    } while (f(low) > 0);
  }
  double at_low = f(low), at_high = f(high);
  constexpr int step_limit = 300;  // bisection alone, every third step, ends within it
  for (int step = 0; step < step_limit && high - low > unit_roundoff * high; ++step) {
    double next = step % 3 == 2 || at_high == at_low ? low + (high - low) / 2
                                                     : low - at_low * (high - low) / (at_high - at_low);
    if (!(next > low && next < high)) next = low + (high - low) / 2;
    if (!(next > low && next < high)) break;
    const double value = f(next);
    if (value == 0) return next;
    if (value < 0) {
      low = next;
      at_low = value;
      at_high /= 2;
    } else {
      high = next;
      at_high = value;
      at_low /= 2;
    }
  }
  return low + (high - low) / 2;
}

Levels levels_of(const Vector& s, double weight, Index k) {
  Levels levels;
  const double lambda = positive_root([&](double l) { return share(s, l, k, levels) - weight; });
  share(s, lambda, k, levels);
  return levels;
}

}  // namespace

double norm_of_largest(const Vector& x, Index k) {
  return std::sqrt(squares_of_largest(sizes_in_order(x), k));
}

/// |x|² = Σ_(i <= top) x_i² + (Σ_(i > top) |x_i|)²/(k - top), top the number for which x_top > the last sum's
/// mean >= x_(top+1) (proposition 2.1 there).
double k_support_norm(const Vector& x, Index k) {
  const Vector s = sizes_in_order(x);
  const double top_size = s.size() > 0 ? s[0] : 0;
  if (!(top_size > 0)) return 0;
  const Vector unit = s / top_size;
  if (entries_not_zero(unit) <= k) return top_size * unit.norm();
  double rest = unit.sum();
  for (Index top = 0; top < k; ++top) {
    const double mean = rest / static_cast<double>(k - top);
    if (unit[top] <= mean || top + 1 == k)
      return top_size * std::sqrt(unit.head(top).squaredNorm() + rest * mean);
    rest = unit.tail(unit.size() - top - 1).sum();
  }
  return top_size * unit.norm();
}

Vector prox_k_support(const Vector& z, double weight, Index k) {
  if (weight == 0) return z;
  if (norm_of_largest(z, k) <= weight) return Vector::Zero(z.size());
  const double size = z.cwiseAbs().maxCoeff();
  const Vector unit = z / size;
  const Levels levels = levels_of(sizes_in_order(unit), weight / size, k);
  Vector x(z.size());
  for (Index i = 0; i < z.size(); ++i) {
    const double entry = std::abs(unit[i]);
    x[i] = 0;
    if (levels.is_full(entry)) x[i] = z[i] / (1 + levels.lambda);
    if (levels.is_between(entry)) x[i] = std::copysign(size * (entry - levels.t), z[i]);
  }
  return x;
}

Matrix prox_k_support_jacobian(const Vector& z, double weight, Index k) {
  const Index n = z.size();
  if (weight == 0) return Matrix::Identity(n, n);
  if (norm_of_largest(z, k) <= weight) return Matrix::Zero(n, n);
  const Levels levels = levels_of(sizes_in_order(z), weight, k);
  const double lambda = levels.lambda, alpha = levels.all_full ? 0 : levels.alpha();
  // Full entries: x = z/(1 + lambda); between: x = z - (lambda/alpha) sign z. F_1 = Σ_between (alpha |z| -
  // lambda) + full - k = 0 and F_2 = lambda² (Σ_full z²/(1 + lambda)² + (k - full)/alpha²) - weight² = 0 give
  // the moves of alpha and lambda.
  Vector sign = Vector::Zero(n), full_part = Vector::Zero(n);
  double full = 0, between = 0, sum_between = 0;
  for (Index i = 0; i < n; ++i) {
    if (levels.is_full(std::abs(z[i]))) {
      ++full;
      full_part[i] = z[i];
    } else if (levels.is_between(std::abs(z[i]))) {
      ++between;
      sign[i] = z[i] > 0 ? 1 : -1;
      sum_between += std::abs(z[i]);
    }
  }
  const double squares = full_part.squaredNorm(), one = 1 + lambda;
  Matrix J = Matrix::Zero(n, n);
  const bool room = (z.array() != 0).count() < k;  // for an entry that leaves 0, which is full at once
  for (Index i = 0; i < n; ++i)
    J(i, i) = full_part[i] != 0 || (room && z[i] == 0) ? 1 / one : std::abs(sign[i]);
  // dF_2: with A = squares/(1+lambda)² + rest/alpha², 2 lambda A dlambda + lambda² dA.
  const double rest = levels.all_full ? 0 : static_cast<double>(k) - full;
  if (between == 0 || levels.all_full) {
    // lambda/(1 + lambda) |z_full| = weight
    const Vector dlambda = -(lambda * one) / squares * full_part;
    J -= full_part * dlambda.transpose() / (one * one);
    return 0.5 * (J + J.transpose());
  }
  const double A = squares / (one * one) + rest / (alpha * alpha);
  const double by_lambda = 2 * lambda * A - 2 * lambda * lambda * squares / (one * one * one);
  const double by_alpha = -2 * lambda * lambda * rest / (alpha * alpha * alpha);
  const Vector of_z = 2 * lambda * lambda / (one * one) * full_part;
  // sum_between dalpha - between dlambda + alpha sign·dz = 0; by_alpha dalpha + by_lambda dlambda + of_z·dz =
  // 0.
  const double determinant = sum_between * by_lambda + between * by_alpha;
  const Vector dalpha = (-by_lambda * alpha * sign - between * of_z) / determinant;
  const Vector dlambda = (by_alpha * alpha * sign - sum_between * of_z) / determinant;
  J -= full_part * dlambda.transpose() / (one * one);
  J -= sign * (dlambda / alpha - lambda / (alpha * alpha) * dalpha).transpose();
  return 0.5 * (J + J.transpose());
}

Vector proj_largest_ball(const Vector& z, double radius, Index k) {
  if (norm_of_largest(z, k) <= radius) return z;
  if (radius == 0) return Vector::Zero(z.size());
  const double size = z.cwiseAbs().maxCoeff(), aim = radius / size;
  const Vector unit = z / size, s = sizes_in_order(unit);
  const bool all_full = entries_not_zero(s) <= k;
  double level = 0;
  const auto shrunk = [&](double mu, double entry) {
    if (all_full || std::abs(entry) >= level * (1 + mu)) return entry / (1 + mu);
    return std::abs(entry) > level ? std::copysign(level, entry) : entry;
  };
  const auto missing = [&](double mu) {
    if (!all_full) level = level_of_k(s, mu, k);
    Vector v(s.size());
    for (Index i = 0; i < s.size(); ++i) v[i] = shrunk(mu, s[i]);
    return aim - std::sqrt(squares_of_largest(v, k));
  };
  const double mu = positive_root(missing);
  missing(mu);
  Vector v(z.size());
  for (Index i = 0; i < z.size(); ++i) v[i] = size * shrunk(mu, unit[i]);
  return v;
}

Vector k_support_slope(const Vector& x, Index k) {
  const double norm = k_support_norm(x, k);
  if (!(norm > 0)) return Vector::Zero(x.size());
  const Vector s = sizes_in_order(x);
  if (entries_not_zero(s) <= k) return x / norm;
  double rest = s.sum();
  Index top = 0;
  for (; top + 1 < k; ++top) {
    if (s[top] <= rest / static_cast<double>(k - top)) break;
    rest = s.tail(s.size() - top - 1).sum();
  }
  const double mean = rest / static_cast<double>(k - top);
  Vector v(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const double size = std::abs(x[i]);
    v[i] = size == 0 ? 0 : std::copysign(std::max(size, mean), x[i]) / norm;
  }
  return v;
}

}  // namespace convex::prox_formulas
