#pragma once

#include "convex/exact/fraction.hpp"

/// Arithmetic of fractions; every result is in lowest terms.
namespace convex::inline exact_arithmetic {

Fraction lowest_terms(Fraction a);
/// Entry i of a vector of fractions, in lowest terms.
Fraction entry(const ExactVector& x, std::size_t i);

Fraction operator+(const Fraction& a, const Fraction& b);
Fraction operator-(const Fraction& a, const Fraction& b);
Fraction operator*(const Fraction& a, const Fraction& b);
/// b is not 0.
Fraction operator/(const Fraction& a, const Fraction& b);
Fraction operator-(const Fraction& a);

inline int sign(const Fraction& a) { return a.numerator.sign(); }
bool operator==(const Fraction& a, const Fraction& b);
bool operator<(const Fraction& a, const Fraction& b);

/// "p/q" in lowest terms, or "p".
std::string text(const Fraction& a);

/// In decimals, rounded to `digits` significant ones (one more after a carry): "-1.25e-3", "7".
std::string decimal_text(const Fraction& a, int digits);

/// Σ x_i y_i.
Fraction dot(const ExactVector& x, const ExactVector& y);

/// The least double that is surely at least sqrt(a), to an ulp or two; a >= 0.
double root_above(const Fraction& a);

}  // namespace convex::inline exact_arithmetic
