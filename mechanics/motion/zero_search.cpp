#include "mechanics/motion/zero_search.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/motion/polynomial_root.hpp"

namespace mechanics {
namespace {

/// Too large to come down to 0 before `end`.
bool stays_away(const Watched& one, double end) {
  double rest = one.rounding, power = end;
  for (std::size_t k = 1; k < one.c.size(); ++k, power *= end) rest += std::abs(one.c[k]) * power;
  return one.c[0] > rest;
}

}  // namespace

std::vector<Zero> first_zeros(const std::vector<Watched>& watched, double end, double together) {
  std::vector<Zero> found;
  for (const Watched& one : watched) {
    if (stays_away(one, end)) continue;
    const std::optional<FirstZero> zero = first_zero(one.c, end, one.rounding);
    if (!zero) continue;
    found.push_back({one.of, one.which, zero->at, zero->is_touch});
    end = std::min(end, zero->at + together);
  }
  std::erase_if(found, [&](const Zero& zero) { return zero.at > end; });
  return found;
}

}  // namespace mechanics
