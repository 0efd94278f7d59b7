#include "convex/atlas/orthant_probability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "convex/atlas/proved_integral.hpp"
#include "convex/interval_arithmetic.hpp"
#include "convex/invariant.hpp"

namespace convex::atlas {
namespace {

constexpr double pi = std::numbers::pi;
/// What angles and means may be off: units of the last place.
constexpr int roundings_of_input = 8;
/// Roundings of a closed form straight from angles, and of the angles.
constexpr double roundings = 16 * unit_roundoff;
constexpr Interval all_correlations{-1, 1}, any_probability{0, 1};

const Interval enclosed_pi = outwards(pi, pi);

/// P(Z_i <= b_i), Z with the correlations r, all of them known between two doubles.
struct Bounds {
  std::size_t k = 0;
  std::array<Interval, 6> b{};
  std::array<std::array<Interval, 6>, 6> r{};
  bool is_centred() const {
    return std::all_of(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(k),
                       [](const Interval& x) { return x.low == 0 && x.high == 0; });
  }
};

struct Enclosed {
  Interval value;
  bool closed = true;
};

Enclosed below(const Bounds& of, double tolerance);

Interval arc_cosine(const Interval& r) {
  return outwards(std::acos(std::min(r.high, 1.0)), std::acos(std::max(r.low, -1.0)), library_units);
}
/// Of one variable. Beyond every double it is 0 or 1 but for less than the least of them.
Interval below_one(const Interval& b) {
  return intersection(any_probability,
                      increasing([](double x) { return std::erfc(-x * std::numbers::sqrt2 / 2) / 2; },
                                 outwards(b.low, b.high, 2)));
}

/// The others when two variables, `first` and `second` of correlation sin θ, are at their bounds; `part` of
/// the correlations of the first are left.
Bounds conditional(const Bounds& of, std::size_t first, std::size_t second, const Interval& part,
                   const Interval& sine, const Interval& rest) {
  Bounds left;
  std::array<Interval, 6> x{}, y{}, deviation{};
  std::array<std::size_t, 6> place{};
  const Interval b = of.b[first], c = of.b[second];
  for (std::size_t l = 0; l < of.k; ++l) {
    if (l == first || l == second) continue;
    const std::size_t i = left.k++;
    place[i] = l;
    x[i] = part * of.r[first][l];
    y[i] = of.r[second][l];
    // x² - 2 sin θ x y + y² = (x - sin θ y)² + cos² θ y².
    deviation[i] = root(interval_at(1) - square(y[i]) - square(x[i] - sine * y[i]) / rest);
    if (of.is_centred()) continue;
    const Interval shift = of.b[l] - (x[i] * (b - sine * c) + y[i] * (c - sine * b)) / rest;
    left.b[i] = shift / deviation[i];
  }
  for (std::size_t i = 0; i < left.k; ++i) {
    left.r[i][i] = interval_at(1);
    for (std::size_t j = 0; j < i; ++j) {
      const Interval shared = y[i] * y[j] + (x[i] - sine * y[i]) * (x[j] - sine * y[j]) / rest;
      left.r[i][j] =
          intersection(all_correlations, (of.r[place[i]][place[j]] - shared) / (deviation[i] * deviation[j]));
      left.r[j][i] = left.r[i][j];
    }
  }
  return left;
}

/// The variable whose largest correlation is the smallest: pairs that are nearly one stay together to the
/// end.
std::size_t loosest(const Bounds& of) {
  std::size_t best = 0;
  double least = 2;
  for (std::size_t i = 0; i < of.k; ++i) {
    double largest = 0;
    for (std::size_t j = 0; j < of.k; ++j)
      if (j != i) largest = std::max(largest, largest_size(of.r[i][j]));
    if (largest < least) {
      least = largest;
      best = i;
    }
  }
  return best;
}

Bounds without(const Bounds& of, std::size_t out) {
  Bounds left;
  left.k = of.k - 1;
  const auto place = [out](std::size_t i) { return i < out ? i : i + 1; };
  for (std::size_t i = 0; i < left.k; ++i) {
    left.b[i] = of.b[place(i)];
    for (std::size_t j = 0; j < left.k; ++j) left.r[i][j] = of.r[place(i)][place(j)];
  }
  return left;
}

/// 1 - rho², rho the multiple correlation of a variable with all others: the last pivot of Cholesky's
/// factors. [0, 1] where the correlations are too near to singular to tell.
Interval left_unexplained(const Bounds& of, std::size_t out) {
  std::array<std::array<Interval, 6>, 6> L{};
  const auto place = [&](std::size_t i) { return i + 1 == of.k ? out : i < out ? i : i + 1; };
  for (std::size_t i = 0; i < of.k; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      Interval sum = i == j ? interval_at(1) : of.r[place(i)][place(j)];
      for (std::size_t l = 0; l < j; ++l) sum = sum - (i == j ? square(L[i][l]) : L[i][l] * L[j][l]);
      if (i + 1 == of.k && i == j) return intersection(any_probability, sum);
      if (i == j && !(sum.low > 0)) return any_probability;
      L[i][j] = i == j ? root(sum) : sum / L[j][j];
    }
  return any_probability;
}

/// At least |g(θ)|, θ = u + iv, for the g of `along`. g is the integral of the density of all variables over
/// the others, their bounds real; with S the inverse of the real part of R⁻¹, R the complex correlations,
///   |g| <= |cos θ| / 2π (det S / (|det R| det S_12))^(1/2).
/// In coordinates in which the others are independent, and explain the first by one of them alone, these are
/// determinants of order two in sin θ / c, c = r_12 / rho.
double size_of_derivative(const Interval& u, const Interval& v, const Interval& c) {
  const auto hyperbolic = [&](double (*f)(double)) { return increasing([f](double x) { return f(x); }, v); };
  const Interval cosh_v = hyperbolic(std::cosh), sinh_v = hyperbolic(std::sinh);
  const double quarter = pi / 2;
  if (!(u.low >= -quarter && u.high <= quarter)) return std::numeric_limits<double>::infinity();
  const Interval sine = increasing([](double x) { return std::sin(x); }, u);
  const double ends[] = {std::cos(u.low), std::cos(u.high)};
  const Interval cosine{
      moved_down(std::min(ends[0], ends[1]), library_units),
      u.low <= 0 && u.high >= 0 ? 1.0 : moved_up(std::max(ends[0], ends[1]), library_units)};
  const Interval a = sine * cosh_v / c, beta = square(cosine * sinh_v / c);
  if (!(largest_size(a) < 1)) return std::numeric_limits<double>::infinity();
  const Interval one = interval_at(1), kappa = beta / (one - square(a));
  const Interval plus = one + kappa, minus = a * (one - kappa);
  const Interval det_S = (plus - minus) * (plus + minus);
  const Interval det_12 = plus * (one + kappa * square(c)) - square(minus * c);
  const Interval det_R = root((square(one - a) + beta) * (square(one + a) + beta));
  const Interval bound = (square(cosine) + square(sinh_v)) * det_S / (det_R * det_12);
  if (!(det_12.low > 0 && det_R.low > 0 && bound.high < std::numeric_limits<double>::infinity()))
    return std::numeric_limits<double>::infinity();
  return moved_up(std::sqrt(bound.high), 2) / (2 * pi) * (1 + 8 * unit_roundoff);
}

/// d/dρ P = φ_2(b_1, b_j; ρ) P(the others | both at their bounds), dρ = cos θ dθ.
Enclosed along(const Bounds& of, std::size_t first, std::size_t second, const Interval& unexplained,
               double tolerance) {
  const Interval whole = of.r[first][second], b = of.b[first], c = of.b[second];
  const Interval end =
      outwards(std::asin(std::max(whole.low, -1.0)), std::asin(std::min(whole.high, 1.0)), library_units);
  const double to = middle(end);
  // c = r_12 / rho, whose sign does not matter.
  const double least = whole.low > 0 ? whole.low : whole.high < 0 ? -whole.high : 0;
  const Interval squared = square(Interval{least, largest_size(whole)});
  const Interval explained = intersection(interval_at(1) - unexplained, {squared.low, 1});
  const Interval steep = intersection(any_probability, root(squared / explained));
  const double farther = std::max(square(b).low, square(c).low);
  const Interval most = increasing([](double x) { return std::exp(x); }, interval_at(-farther / 2));
  AnalyticFunction g;
  g.range = {0, (most / (interval_at(2) * enclosed_pi)).high};
  g.singularity = std::asin(steep.low);
  g.size = [steep](const Interval& u, const Interval& v) { return size_of_derivative(u, v, steep); };
  g.at = [&](const Interval& theta) {
    const Interval sine = increasing([](double x) { return std::sin(x); }, theta);
    const double cosines[] = {std::cos(theta.low), std::cos(theta.high)};
    const Interval rest = square(
        {std::max(0.0, moved_down(std::min(cosines[0], cosines[1]), library_units)),
         theta.low <= 0 && theta.high >= 0 ? 1 : moved_up(std::max(cosines[0], cosines[1]), library_units)});
    // b² - 2bc sin θ + c² = (b - c sin θ)² + c² cos² θ.
    const Interval exponent = square(b - c * sine) / rest + square(c);
    const Interval density = increasing([](double x) { return std::exp(x); }, exponent * interval_at(-0.5)) /
                             (interval_at(2) * enclosed_pi);
    const Interval known = intersection({0, density.high}, density);
    if (of.k == 2 || known.high == 0) return known;
    const Interval part = sine / whole;
    return known * below(conditional(of, first, second, part, sine, rest), tolerance).value;
  };
  const Interval found = proved_integral(g, to, tolerance / 2);
  const double missed = moved_up((end.high - end.low) * g.range.high, 2);
  return {found + Interval{-missed, missed}, false};
}

/// Centred, up to three: the solid angle.
Interval solid_angle(const Bounds& of) {
  const Interval first = arc_cosine(of.r[0][1]);
  if (of.k == 2) return (enclosed_pi - first) / (interval_at(2) * enclosed_pi);
  const Interval sum = first + arc_cosine(of.r[0][2]) + arc_cosine(of.r[1][2]);
  return (interval_at(2) * enclosed_pi - sum) / (interval_at(4) * enclosed_pi);
}

Enclosed below(const Bounds& of, double tolerance) {
  if (of.k == 0) return {interval_at(1), true};
  if (of.k == 1) return {below_one(of.b[0]), true};
  if (of.k <= 3 && of.is_centred()) return {intersection(any_probability, solid_angle(of)), true};
  const std::size_t out = loosest(of);
  const auto is_zero = [](const Interval& r) { return r.low == 0 && r.high == 0; };
  double size = 0;
  for (std::size_t j = 0; j < of.k; ++j) size += j != out && !is_zero(of.r[out][j]) ? 1 : 0;
  // Half of the tolerance for the product, half for the integrals; theirs holds within them as well.
  const double part = tolerance / (2 * (1 + size));
  Enclosed sum = below(without(of, out), part);
  sum.value = below_one(of.b[out]) * sum.value;
  if (size == 0) return sum;
  const Interval unexplained = left_unexplained(of, out);
  for (std::size_t j = 0; j < of.k; ++j)
    if (j != out && !is_zero(of.r[out][j]))
      sum.value = sum.value + along(of, out, j, unexplained, part).value;
  return {intersection(any_probability, sum.value), false};
}

}  // namespace

Probability operator*(const Probability& p, const Probability& q) {
  const double value = p.value * q.value;
  return {value,
          moved_up(p.error * (std::abs(q.value) + q.error) + std::abs(p.value) * q.error +
                       unit_roundoff * std::abs(value),
                   4),
          p.closed && q.closed};
}

void add(Probability& sum, int sign, const Probability& p) {
  sum.value += sign * p.value;
  sum.error = moved_up(sum.error + p.error + unit_roundoff * std::abs(sum.value), 2);
  sum.closed = sum.closed && p.closed;
}

Probability not_negative(Probability p) {
  p.value = std::max(p.value, 0.0);
  return p;
}

Probability orthant_probability(const NormalVariables& of, double tolerance) {
  const Index k = of.mean.size();
  invariant(k <= most_variables, "an orthant has at most six dimensions here");
  // Closed forms straight from the angles; elsewhere the cosine's rounding is paid for.
  if (of.mean.isZero(0) && k == 2) return {(pi - of.angles(0, 1)) / (2 * pi), roundings, true};
  if (of.mean.isZero(0) && k == 3)
    return {std::max(0.0, 2 * pi - of.angles(0, 1) - of.angles(0, 2) - of.angles(1, 2)) / (4 * pi), roundings,
            true};
  Bounds bounds;
  bounds.k = static_cast<std::size_t>(k);
  for (Index i = 0; i < k; ++i) {
    const double b = of.mean[i];
    const auto row = static_cast<std::size_t>(i);
    bounds.b[row] = b == 0 ? Interval{} : outwards(b, b, roundings_of_input);
    for (Index j = 0; j < k; ++j) {
      const double angle = of.angles(i, j);
      const Interval around = outwards(angle, angle, roundings_of_input);
      bounds.r[row][static_cast<std::size_t>(j)] =
          i == j ? interval_at(1)
                 : intersection(all_correlations,
                                outwards(std::cos(around.high), std::cos(around.low), library_units));
    }
  }
  const Enclosed found = below(bounds, tolerance);
  const double value = middle(found.value);
  return {value, moved_up(std::max(found.value.high - value, value - found.value.low)), found.closed};
}

}  // namespace convex::atlas
