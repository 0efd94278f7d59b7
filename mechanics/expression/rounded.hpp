#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace mechanics::expression {

/// A double and how far it may be from the number that it stands for: |value - meant| <= radius, infinite or
/// NaN where nothing is known. Arithmetic gives the same doubles as plain doubles do. What an operation
/// rounds is found exactly (Knuth's sum, a fused product or remainder), so that radii of what is exact stay
/// 0; functions of the library of the system are trusted to some units of the last place. Radii are rounded
/// up.
struct Rounded {
  double value = 0, radius = 0;

  Rounded() = default;
  Rounded(double exact) : value(exact) {}  // NOLINT: a number that is what it says
  Rounded(double rounded, double bound) : value(rounded), radius(bound) {}
  bool is_exact() const { return radius == 0; }
  /// Its sign is that of the double for all that is known, or not.
  bool is_undecided() const { return radius != 0 && may_be_zero(); }
  bool may_be_zero() const { return !(std::abs(value) > radius); }
};

/// A bound made of a few terms, each rounded: this much more covers it.
inline double widened(double bound) { return bound * (1 + 0x1p-48); }

/// What sin, pow and the like may be off, relative to their value: 3 units of the last place. (The GNU
/// library documents at most 2.)
inline constexpr double function_rounding = 6 * 0x1p-53;

/// Products below this may have lost more than their rounding.
inline constexpr double smallest_product = 0x1p-900, lost_below = 0x1p-1070;

inline Rounded operator-(Rounded a) { return {-a.value, a.radius}; }

inline Rounded operator+(Rounded a, Rounded b) {
  const double sum = a.value + b.value, part = sum - a.value;
  const double rest = (a.value - (sum - part)) + (b.value - part);
  return {sum, widened(a.radius + b.radius + std::abs(rest))};
}

inline Rounded operator-(Rounded a, Rounded b) { return a + -b; }

inline Rounded operator*(Rounded a, Rounded b) {
  const double product = a.value * b.value;
  double radius = std::abs(std::fma(a.value, b.value, -product));
  if (std::abs(product) < smallest_product && a.value != 0 && b.value != 0) radius += lost_below;
  if (a.radius != 0 || b.radius != 0)
    radius += std::abs(a.value) * b.radius + std::abs(b.value) * a.radius + a.radius * b.radius;
  return {product, widened(radius)};
}

inline Rounded operator/(Rounded a, Rounded b) {
  const double quotient = a.value / b.value, least = std::abs(b.value) - b.radius;
  if (!(least > 0)) return {quotient, std::numeric_limits<double>::infinity()};
  double radius = std::abs(std::fma(-quotient, b.value, a.value)) + a.radius + std::abs(quotient) * b.radius;
  if (std::abs(quotient) < smallest_product && a.value != 0) radius += lost_below * std::abs(b.value);
  return {quotient, widened(radius / least)};
}

inline Rounded& operator+=(Rounded& a, Rounded b) { return a = a + b; }
inline Rounded& operator-=(Rounded& a, Rounded b) { return a = a - b; }

/// Signs and equality are those of the doubles: what is evaluated takes the same branches as without radii.
inline bool operator==(Rounded a, double b) { return a.value == b; }
inline bool operator>(Rounded a, double b) { return a.value > b; }
inline bool operator<(Rounded a, double b) { return a.value < b; }

Rounded sin(Rounded a);
Rounded cos(Rounded a);
Rounded tan(Rounded a);
Rounded asin(Rounded a);
Rounded acos(Rounded a);
Rounded atan(Rounded a);
/// The angle of (x, y), in (-π, π]: that of doubles, but -0 is 0, so that the ray y = 0 > x has π from both
/// zeros.
double atan2(double y, double x);
Rounded atan2(Rounded a, Rounded b);
Rounded sinh(Rounded a);
Rounded cosh(Rounded a);
Rounded tanh(Rounded a);
Rounded exp(Rounded a);
Rounded log(Rounded a);
Rounded sqrt(Rounded a);
Rounded abs(Rounded a);
Rounded pow(Rounded a, Rounded b);
Rounded hypot(Rounded a, Rounded b);

}  // namespace mechanics::expression
