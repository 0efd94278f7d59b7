#pragma once

#include "convex/nearest_point/multipliers/exact_multipliers.hpp"
#include "tests/oracles/rational_kkt.hpp"

namespace oracles {

/// The same fractions as GMP reads them from their digits.
inline Rational rational(const convex::Fraction& a) {
  Rational value(a.numerator.text() + "/" + a.denominator.text());
  value.canonicalize();
  return value;
}

inline RationalVector rationals(const convex::ExactVector& x) {
  RationalVector all;
  for (const convex::Integer& numerator : x.numerators) all.push_back(rational({numerator, x.denominator}));
  return all;
}

}  // namespace oracles
