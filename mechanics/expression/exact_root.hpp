#pragma once

#include <optional>

#include "convex/exact/fraction_arithmetic.hpp"

namespace mechanics::expression {

/// The root of a square of a fraction, whose numerator and denominator have up to 52 bits; none of others.
std::optional<convex::Fraction> exact_root(const convex::Fraction& a);

}  // namespace mechanics::expression
