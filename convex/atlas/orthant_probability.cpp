#include "convex/atlas/orthant_probability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "convex/atlas/quadrature.hpp"
#include "convex/invariant.hpp"

namespace convex::atlas {
namespace {

constexpr double pi = std::numbers::pi;
/// Roundings of a closed form, and of what an integrand is made of.
constexpr double roundings = 16 * unit_roundoff;
/// Beyond so many standard deviations a probability is 0 or 1 but for 1e-300.
constexpr double certain = 37.5;

/// P(Z_i <= b_i), Z with the correlations r.
struct Bounds {
  std::size_t k = 0;
  std::array<double, 6> b{};
  std::array<std::array<double, 6>, 6> r{};
  bool is_centred() const {
    return std::all_of(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(k),
                       [](double x) { return x == 0; });
  }
};

Probability below(const Bounds& of, double tolerance);

double angle_of(double correlation) { return std::acos(std::clamp(correlation, -1.0, 1.0)); }

/// Without the variables that are below their bounds for certain.
Bounds uncertain(const Bounds& of) {
  Bounds left;
  std::array<std::size_t, 6> kept{};
  for (std::size_t i = 0; i < of.k; ++i)
    if (of.b[i] < certain) kept[left.k++] = i;
  for (std::size_t i = 0; i < left.k; ++i) {
    left.b[i] = of.b[kept[i]];
    for (std::size_t j = 0; j < left.k; ++j) left.r[i][j] = of.r[kept[i]][kept[j]];
  }
  return left;
}

/// The others when two variables, `first` and `second` of correlation sin θ, are at their bounds; `part` of
/// the correlations of the first are left.
Bounds conditional(const Bounds& of, std::size_t first, std::size_t second, double part, double sine) {
  Bounds left;
  const double rest = std::max(1 - sine * sine, unit_roundoff);
  std::array<double, 6> deviation{};
  std::array<std::size_t, 6> place{};
  const double b = of.b[first], c = of.b[second];
  for (std::size_t l = 0; l < of.k; ++l) {
    if (l == first || l == second) continue;
    const double x = part * of.r[first][l], y = of.r[second][l];
    const double variance = 1 - (x * x - 2 * sine * x * y + y * y) / rest;
    deviation[left.k] = std::sqrt(std::max(variance, unit_roundoff));
    left.b[left.k] = (of.b[l] - (x * (b - sine * c) + y * (c - sine * b)) / rest) / deviation[left.k];
    place[left.k++] = l;
  }
  for (std::size_t i = 0; i < left.k; ++i)
    for (std::size_t j = 0; j < left.k; ++j) {
      const double xi = part * of.r[first][place[i]], yi = of.r[second][place[i]];
      const double xj = part * of.r[first][place[j]], yj = of.r[second][place[j]];
      const double shared = (xi * xj - sine * (xi * yj + yi * xj) + yi * yj) / rest;
      left.r[i][j] =
          std::clamp((of.r[place[i]][place[j]] - shared) / (deviation[i] * deviation[j]), -1.0, 1.0);
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
      if (j != i) largest = std::max(largest, std::abs(of.r[i][j]));
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

/// d/dρ P = φ_2(b_1, b_j; ρ) P(the others | both at their bounds), dρ = cos θ dθ.
Probability along(const Bounds& of, std::size_t first, std::size_t second, double tolerance) {
  const double whole = of.r[first][second], b = of.b[first], c = of.b[second];
  const double end = std::asin(whole);
  double inner = 0;
  const auto integrand = [&](double theta) {
    const double sine = std::sin(theta), cosine = std::cos(theta);
    // b² - 2bc sin θ + c² = (b - c sin θ)² + c² cos² θ.
    const double apart = b - c * sine;
    const double exponent = (apart == 0 ? 0 : apart * apart / (cosine * cosine)) + c * c;
    const double density = std::exp(-exponent / 2) / (2 * pi);
    if (density == 0 || of.k == 2) return density;
    const Probability others = below(conditional(of, first, second, sine / whole, sine), tolerance);
    inner = std::max(inner, others.error * density);
    return density * others.value;
  };
  const Quadrature found = integral(integrand, 0, end, tolerance);
  return {found.value, found.error + (inner + roundings) * std::abs(end), false};
}

Probability below(const Bounds& given, double tolerance) {
  const Bounds of = uncertain(given);
  if (of.k == 0) return {1, given.k == 0 ? 0.0 : roundings, true};
  for (std::size_t i = 0; i < of.k; ++i)
    if (of.b[i] < -certain) return {0, roundings, true};
  if (of.k == 1) return {std::erfc(-of.b[0] * std::numbers::sqrt2 / 2) / 2, roundings, true};
  if (of.k <= 3 && of.is_centred()) {
    const double first = angle_of(of.r[0][1]);
    if (of.k == 2) return {(pi - first) / (2 * pi), roundings, true};
    const double sum = first + angle_of(of.r[0][2]) + angle_of(of.r[1][2]);
    return {std::max(0.0, 2 * pi - sum) / (4 * pi), roundings, true};
  }
  const std::size_t out = loosest(of);
  double size = 0;
  for (std::size_t j = 0; j < of.k; ++j) size += j != out && of.r[out][j] != 0 ? 1 : 0;
  // Half of the tolerance for the product, half for the integrals; theirs holds within them as well.
  const double part = tolerance / (2 * (1 + size));
  Bounds alone;
  alone.k = 1;
  alone.b[0] = of.b[out];
  Probability sum = below(alone, part) * below(without(of, out), part);
  for (std::size_t j = 0; j < of.k; ++j)
    if (j != out && of.r[out][j] != 0) add(sum, 1, along(of, out, j, part));
  return sum;
}

}  // namespace

Probability operator*(const Probability& p, const Probability& q) {
  return {p.value * q.value, p.error * (q.value + q.error) + p.value * q.error + unit_roundoff,
          p.closed && q.closed};
}

void add(Probability& sum, int sign, const Probability& p) {
  sum.value += sign * p.value;
  sum.error += p.error + unit_roundoff * std::abs(sum.value);
  sum.closed = sum.closed && p.closed;
}

Probability orthant_probability(const NormalVariables& of, double tolerance) {
  const Index k = of.mean.size();
  invariant(k <= most_variables, "an orthant has at most six dimensions here");
  // Closed forms straight from the angles; elsewhere the cosine's rounding is paid for.
  if (of.mean.isZero(0) && k == 2) return {(pi - of.angles(0, 1)) / (2 * pi), roundings, true};
  if (of.mean.isZero(0) && k == 3)
    return {(2 * pi - of.angles(0, 1) - of.angles(0, 2) - of.angles(1, 2)) / (4 * pi), roundings, true};
  Bounds bounds;
  bounds.k = static_cast<std::size_t>(k);
  double rounding = 0;
  for (Index i = 0; i < k; ++i) {
    bounds.b[static_cast<std::size_t>(i)] = of.mean[i];
    for (Index j = 0; j < k; ++j) {
      const double angle = of.angles(i, j), sine = std::sin(angle);
      bounds.r[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = i == j ? 1 : std::cos(angle);
      // |dP/dρ| <= 1/(2pi sin θ).
      if (i < j) rounding += std::min(unit_roundoff / sine, std::sqrt(2 * unit_roundoff)) / pi;
    }
  }
  Probability found = below(bounds, tolerance);
  found.error += rounding;
  return found;
}

}  // namespace convex::atlas
