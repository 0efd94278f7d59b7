#include "mechanics/expression/range.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/expression/rounded.hpp"

namespace mechanics::expression {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
constexpr Range all_numbers{};

double below(double x) { return std::nextafter(x, -endless); }
double above(double x) { return std::nextafter(x, endless); }
Range outwards(double low, double high) { return {below(low), above(high)}; }

/// Of a function of the library: 4 units of the last place each way.
Range of_library(double low, double high) {
  for (int k = 0; k < 4; ++k) low = below(low), high = above(high);
  return {low, high};
}

double product(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

Range multiplied(Range a, Range b) {
  const double ends[] = {product(a.low, b.low), product(a.low, b.high), product(a.high, b.low),
                         product(a.high, b.high)};
  return outwards(*std::min_element(ends, ends + 4), *std::max_element(ends, ends + 4));
}

Range divided(Range a, Range b) {
  if (b.low == 0 && b.high == 0) return nothing_in_range;
  if (b.contains(0)) return all_numbers;
  return multiplied(a, outwards(1 / b.high, 1 / b.low));
}

Range negated(Range a) { return {-a.high, -a.low}; }
/// Whether the double a + b is the sum (Knuth's error of a sum); not where it overflows.
bool is_exact_sum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return (a - (sum - of_b)) + (b - of_b) == 0;
}
Range added(Range a, Range b) {
  const double low = a.low + b.low, high = a.high + b.high;
  return {is_exact_sum(a.low, b.low) ? low : below(low), is_exact_sum(a.high, b.high) ? high : above(high)};
}

/// Of a function with period 2 pi that is 1 at `top` and -1 at `bottom`, and monotone between.
Range waves(Range a, double (*f)(double), double top, double bottom) {
  constexpr double period = 2 * std::numbers::pi, farthest = 1e6, slack = 1e-9;
  if (!(std::abs(a.low) < farthest && std::abs(a.high) < farthest) || a.high - a.low >= period)
    return {-1, 1};
  const auto passes = [&](double place) {
    return std::ceil((a.low - place) / period - slack) <= std::floor((a.high - place) / period + slack);
  };
  const double one = f(a.low), other = f(a.high);
  Range r = of_library(std::min(one, other), std::max(one, other));
  if (passes(top)) r.high = 1;
  if (passes(bottom)) r.low = -1;
  return intersection(r, {-1, 1});
}

Range increasing(Range a, double (*f)(double), Range domain, Range values) {
  a = intersection(a, domain);
  if (a.is_empty()) return nothing_in_range;
  return intersection(of_library(f(a.low), f(a.high)), values);
}

Range absolute(Range a) {
  if (a.low >= 0) return a;
  if (a.high <= 0) return negated(a);
  return {0, std::max(-a.low, a.high)};
}

Range raised(Range a, Range exponent) {
  if (exponent.low != exponent.high) {
    if (!(a.low > 0)) {
      // Only whole exponents have a base below 0.
      if (!(exponent.low > 0) || std::floor(exponent.high) >= exponent.low) return all_numbers;
      a = intersection(a, {0, endless});
      if (a.is_empty()) return nothing_in_range;
    }
    const double ends[] = {std::pow(a.low, exponent.low), std::pow(a.low, exponent.high),
                           std::pow(a.high, exponent.low), std::pow(a.high, exponent.high)};
    if (std::any_of(ends, ends + 4, [](double x) { return std::isnan(x); })) return {0, endless};
    return intersection(of_library(*std::min_element(ends, ends + 4), *std::max_element(ends, ends + 4)),
                        {0, endless});
  }
  const double e = exponent.low;
  const bool whole = e == std::floor(e) && std::abs(e) < 0x1p31;
  if (e < 0) return divided({1, 1}, raised(a, {-e, -e}));
  if (!whole) a = intersection(a, {0, endless});
  if (a.is_empty()) return nothing_in_range;
  const bool odd = whole && std::fmod(e, 2) != 0;
  if (odd) return of_library(std::pow(a.low, e), std::pow(a.high, e));
  const Range size = absolute(a);
  return intersection(of_library(std::pow(size.low, e), std::pow(size.high, e)), {0, endless});
}

/// What has a power in `result`, for a whole exponent >= 1; everything for others.
Range root_of(Range result, double e, Range a) {
  if (e != std::floor(e) || e < 1 || e > 0x1p31) return all_numbers;
  if (std::fmod(e, 2) != 0) {
    const auto root = [&](double x) { return std::copysign(std::pow(std::abs(x), 1 / e), x); };
    const Range r = of_library(root(result.low), root(result.high));
    return of_library(r.low, r.high);
  }
  if (result.high < 0) return nothing_in_range;
  const Range most = of_library(0, std::pow(result.high, 1 / e));
  const double least = result.low > 0 ? of_library(std::pow(result.low, 1 / e), 0).low : 0;
  if (a.low > -least) return {least, most.high};
  if (a.high < least) return {-most.high, -least};
  return {-most.high, most.high};
}

/// Of the point (x, y). Where the box does not meet the cut, y = 0 > x, from below, it is monotone along the
/// sides, so that corners have the ends.
Range angle(Range y, Range x) {
  constexpr Range all_angles{-3.2, 3.2};
  const bool is_above = y.low >= 0;
  if (!(is_above || x.low > 0 || y.high < 0) || !std::isfinite(x.low + x.high + y.low + y.high))
    return all_angles;
  const double ends[] = {atan2(y.low, x.low), atan2(y.low, x.high), atan2(y.high, x.low),
                         atan2(y.high, x.high)};
  return of_library(*std::min_element(ends, ends + 4), *std::max_element(ends, ends + 4));
}

}  // namespace

Range intersection(Range a, Range b) { return {std::max(a.low, b.low), std::min(a.high, b.high)}; }

Range hull(Range a, Range b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Range value(Operation operation, Range a, Range b) {
  using enum Operation;
  if (is_where(operation)) {  // the operand that is not taken may be undefined
    if (a.is_empty()) return nothing_in_range;
    const bool taken_above = operation == where_not_negative;
    const bool may_be_above = a.high >= 0, may_be_below = a.low < 0;
    const bool may_be_taken = taken_above ? may_be_above : may_be_below;
    const bool may_be_left = taken_above ? may_be_below : may_be_above;
    if (!may_be_left) return b;
    return may_be_taken ? hull(b, {0, 0}) : Range{0, 0};
  }
  if (a.is_empty() || (arity(operation) == 2 && b.is_empty())) return nothing_in_range;
  constexpr double half_turn = std::numbers::pi / 2;
  switch (operation) {
    case negate:
      return negated(a);
    case add:
      return added(a, b);
    case subtract:
      return added(a, negated(b));
    case multiply:
      return multiplied(a, b);
    case divide:
      return divided(a, b);
    case power:
      return raised(a, b);
    case Operation::sin:
      return waves(a, std::sin, half_turn, -half_turn);
    case Operation::cos:
      return waves(a, std::cos, 0, std::numbers::pi);
    case Operation::asin:
      return increasing(a, std::asin, {-1, 1}, {-1.6, 1.6});
    case Operation::acos:
      return intersection(
          added({half_turn, above(half_turn)}, negated(increasing(a, std::asin, {-1, 1}, {-1.6, 1.6}))),
          {0, 3.2});
    case Operation::atan:
      return increasing(a, std::atan, all_numbers, {-1.6, 1.6});
    case Operation::atan2:
      return angle(a, b);
    case Operation::sinh:
      return increasing(a, std::sinh, all_numbers, all_numbers);
    case Operation::cosh:
      return increasing(absolute(a), std::cosh, all_numbers, {1, endless});
    case Operation::tanh:
      return increasing(a, std::tanh, all_numbers, {-1, 1});
    case Operation::exp:
      return increasing(a, std::exp, all_numbers, {0, endless});
    case Operation::log:
      return increasing(a, std::log, {0, endless}, all_numbers);
    case Operation::sqrt:
      return increasing(a, std::sqrt, {0, endless}, {0, endless});
    case Operation::abs:
      return absolute(a);
    case Operation::sign:
      return {a.low > 0 ? 1.0 : a.low == 0 ? 0.0 : -1.0, a.high < 0 ? -1.0 : a.high == 0 ? 0.0 : 1.0};
    case Operation::min:
      return {std::min(a.low, b.low), std::min(a.high, b.high)};
    case Operation::max:
      return {std::max(a.low, b.low), std::max(a.high, b.high)};
    default:
      return all_numbers;
  }
}

void narrow(Operation operation, Range result, Range& a, Range& b) {
  using enum Operation;
  switch (operation) {
    case negate:
      a = intersection(a, negated(result));
      break;
    case add:
      a = intersection(a, added(result, negated(b)));
      b = intersection(b, added(result, negated(a)));
      break;
    case subtract:
      a = intersection(a, added(result, b));
      b = intersection(b, added(a, negated(result)));
      break;
    case multiply:
      if (!b.contains(0)) a = intersection(a, divided(result, b));
      if (!a.is_empty() && !a.contains(0)) b = intersection(b, divided(result, a));
      break;
    case divide:
      a = intersection(a, multiplied(result, b));
      break;
    case power:
      if (b.low == b.high) a = intersection(a, root_of(result, b.low, a));
      break;
    case Operation::sqrt:
      if (result.high < 0)
        a = nothing_in_range;
      else
        a = intersection(a,
                         {std::max(0.0, below(product(std::max(0.0, result.low), std::max(0.0, result.low)))),
                          above(product(result.high, result.high))});
      break;
    case Operation::abs:
      a = intersection(a, {-result.high, result.high});
      break;
    case Operation::min:
      a.low = std::max(a.low, result.low);
      b.low = std::max(b.low, result.low);
      break;
    case Operation::max:
      a.high = std::min(a.high, result.high);
      b.high = std::min(b.high, result.high);
      break;
    default:
      break;
  }
}

}  // namespace mechanics::expression
