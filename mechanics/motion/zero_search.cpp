#include "mechanics/motion/zero_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "convex/invariant.hpp"
#include "mechanics/motion/polynomial_root.hpp"

namespace mechanics::inline motions {
namespace {

/// A value by Horner's rule is rounded about so many times, relative to what it is the sum of.
constexpr double roundings_of_value = 8;

/// c_k end^k, without the zeros at the end. One factor after the other: end^k alone may leave the range of
/// doubles.
std::span<const double> on_unit_interval(const std::vector<double>& c, double end,
                                         std::array<double, most_coefficients>& to) {
  std::size_t count = c.size();
  while (count > 0 && c[count - 1] == 0) --count;
  convex::invariant(count <= most_coefficients, "series of a motion have fewer coefficients");
  const double highest = std::abs(std::log2(end)) * static_cast<double>(count);
  constexpr double surely_inside = 1000;  // powers of 2
  double power = 1;
  for (std::size_t k = 0; k < count; ++k) {
    to[k] = c[k];
    if (highest < surely_inside) {
      to[k] *= power;
      power *= end;
    } else {
      for (std::size_t j = 0; j < k; ++j) to[k] *= end;
    }
  }
  return {to.data(), count};
}

}  // namespace

std::vector<Zero> first_zeros(const std::vector<Watched>& watched, double end, double together) {
  std::vector<Zero> found;
  if (!(end > 0)) return found;
  std::array<double, most_coefficients> memory;
  for (const Watched& one : watched) {
    const std::span<const double> c = on_unit_interval(one.c, end, memory);
    double all = 0;  // what a value is the sum of
    for (const double term : c) all += std::abs(term);
    const double rounding = one.rounding + roundings_of_value * convex::unit_roundoff * all;
    if (all == 0 || c[0] > all - c[0] + rounding) continue;  // too large to come down to 0
    const std::optional<FirstZero> zero = first_zero(c, 1, rounding);
    if (!zero) continue;
    const double at = zero->at * end;
    found.push_back({one.of, one.which, at, zero->is_touch});
    end = std::min(end, at + together);
  }
  std::erase_if(found, [&](const Zero& zero) { return zero.at > end; });
  return found;
}

}  // namespace mechanics::inline motions
