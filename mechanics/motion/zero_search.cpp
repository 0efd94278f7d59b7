#include "mechanics/motion/zero_search.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/motion/polynomial_root.hpp"

namespace mechanics {
namespace {

/// A value by Horner's rule is rounded about so many times, relative to what it is the sum of.
constexpr double roundings_of_value = 8;

/// Σ |c_k| end^k: what a value is the sum of.
double size(const Watched& one, double end) {
  double sum = 0, power = 1;
  for (const double c : one.c) {
    sum += std::abs(c) * power;
    power *= end;
  }
  return sum;
}

}  // namespace

std::vector<Zero> first_zeros(const std::vector<Watched>& watched, double end, double together) {
  std::vector<Zero> found;
  for (const Watched& one : watched) {
    const double all = size(one, end);
    const double rounding = one.rounding + roundings_of_value * convex::unit_roundoff * all;
    if (all == 0 || one.c[0] > all - one.c[0] + rounding) continue;  // too large to come down to 0
    const std::optional<FirstZero> zero = first_zero(one.c, end, rounding);
    if (!zero) continue;
    found.push_back({one.of, one.which, zero->at, zero->is_touch});
    end = std::min(end, zero->at + together);
  }
  std::erase_if(found, [&](const Zero& zero) { return zero.at > end; });
  return found;
}

}  // namespace mechanics
