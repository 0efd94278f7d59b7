#include "mechanics/expression/exact_root.hpp"

#include <cmath>

namespace mechanics::expression {

std::optional<convex::Fraction> exact_root(const convex::Fraction& a) {
  if (convex::sign(a) < 0) return std::nullopt;
  // Numerator and denominator of a in lowest terms are squares themselves.
  const convex::Fraction lowest = convex::lowest_terms(a);
  constexpr double largest = 0x1p52;
  const double p = std::sqrt(convex::nearest_quotient(lowest.numerator, 1));
  const double q = std::sqrt(convex::nearest_quotient(lowest.denominator, 1));
  if (!(p < largest && q < largest)) return std::nullopt;
  const convex::Fraction candidate{static_cast<std::int64_t>(p), static_cast<std::int64_t>(q)};
  if (!(candidate * candidate == lowest)) return std::nullopt;
  return candidate;
}

}  // namespace mechanics::expression
