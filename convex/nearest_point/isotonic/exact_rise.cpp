#include "convex/nearest_point/isotonic/exact_rise.hpp"

#include <cmath>

#include "convex/exact/fraction_arithmetic.hpp"

namespace convex::inline isotonic {
namespace {

/// Denominators grow with every factor that is no power of two.
constexpr Index most_odd_factors = 1000;

bool is_power_of_two(double c) {
  int exponent = 0;
  return std::abs(std::frexp(c, &exponent)) == 0.5;
}

/// The heights of members over the first one where no row below has any slack.
class Heights {
 public:
  Heights(const StringMembers& members, Index first) : members_(members), next_(first) {}
  /// Members in turn.
  Fraction of(Index k) {
    for (; next_ < k; ++next_) {
      const StringMember above = members_(next_ + 1);
      if (!is_power_of_two(above.factor)) ++odd_;
      height_ = height_ + fraction(above.bound) / fraction(above.factor);
    }
    return height_;
  }
  bool is_too_long() const { return odd_ > most_odd_factors; }

 private:
  const StringMembers& members_;
  Index next_, odd_ = 0;
  Fraction height_;
};

/// The mean of linear - mass height over the members, by mass; none when it takes too long.
std::optional<Fraction> mean(const StringMembers& members, Heights& heights, Index begin, Index end) {
  Fraction mass, linear;
  for (Index k = begin; k < end; ++k) {
    const StringMember member = members(k);
    const Fraction own = fraction(member.mass);
    mass = mass + own;
    linear = linear + fraction(member.linear) - own * heights.of(k);
    if (heights.is_too_long()) return std::nullopt;
  }
  return linear / mass;
}

}  // namespace

std::optional<int> rise(const StringMembers& members, Index first, Index middle, Index end) {
  Heights heights(members, first);
  const auto below = mean(members, heights, first, middle);
  if (!below) return std::nullopt;
  const auto above = mean(members, heights, middle, end);
  if (!above) return std::nullopt;
  return sign(*above - *below);
}

std::optional<int> rise_over_floor(const StringMembers& members, Index first, Index middle, Index end) {
  Heights heights(members, first);
  const StringMember lowest = members(first);
  const auto above = mean(members, heights, middle, end);
  if (!above) return std::nullopt;
  return sign(*above - fraction(lowest.bound) / fraction(lowest.factor));
}

}  // namespace convex::inline isotonic
