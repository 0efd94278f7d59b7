#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "convex/interval.hpp"

/// Arithmetic of intervals (Moore, Kearfott and Cloud 2009): what it gives contains what the operation is of
/// any numbers in its operands. Ends are moved outwards by a unit of the last place; functions of the
/// system's library are trusted to eight. What is not a number counts as unbounded.
namespace convex {

inline double moved_down(double x, int units = 1) {
  constexpr double unit = std::numeric_limits<double>::epsilon(), least = 1e-320;
  const double moved = x - (std::abs(x) * (units * unit) + least);
  // inf - inf, and what is no number.
  return moved == moved ? moved : -std::numeric_limits<double>::infinity();
}
inline double moved_up(double x, int units = 1) { return -moved_down(-x, units); }

inline constexpr int library_units = 8;

inline Interval outwards(double low, double high, int units = 1) {
  return {moved_down(low, units), moved_up(high, units)};
}
inline Interval interval_at(double x) { return {x, x}; }
inline double middle(const Interval& a) { return a.low + 0.5 * (a.high - a.low); }
inline Interval intersection(const Interval& a, const Interval& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}
inline double largest_size(const Interval& a) { return std::max(std::abs(a.low), std::abs(a.high)); }

inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator+(const Interval& a, const Interval& b) {
  return outwards(a.low + b.low, a.high + b.high);
}
inline Interval operator-(const Interval& a, const Interval& b) { return a + -b; }
inline Interval operator*(const Interval& a, const Interval& b) {
  if (a.low >= 0) {
    if (b.low >= 0) return outwards(a.low * b.low, a.high * b.high);
    return outwards(a.high * b.low, (b.high <= 0 ? a.low : a.high) * b.high);
  }
  if (a.high <= 0) return -(-a * b);
  if (b.low >= 0) return outwards(a.low * b.high, a.high * b.high);
  if (b.high <= 0) return outwards(a.high * b.low, a.low * b.low);
  return outwards(std::min(a.low * b.high, a.high * b.low), std::max(a.low * b.low, a.high * b.high));
}
/// Unbounded where b contains 0.
inline Interval operator/(const Interval& a, const Interval& b) {
  if (b.low <= 0 && b.high >= 0)
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  return a * outwards(1 / b.high, 1 / b.low);
}
inline Interval square(const Interval& a) {
  const double p = a.low * a.low, q = a.high * a.high;
  const bool passes = a.low <= 0 && a.high >= 0;
  return {passes ? 0 : std::max(0.0, moved_down(std::min(p, q))), moved_up(std::max(p, q))};
}
/// Of what of it is not negative.
inline Interval root(const Interval& a) {
  return {a.low <= 0 ? 0 : std::max(0.0, moved_down(std::sqrt(a.low))),
          moved_up(std::sqrt(std::max(a.high, 0.0)))};
}
/// Of a function that increases, by the system's library.
template <class Function>
Interval increasing(Function f, const Interval& a) {
  return outwards(f(a.low), f(a.high), library_units);
}

}  // namespace convex
