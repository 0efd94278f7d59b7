#pragma once

#include <optional>
#include <string>

#include "convex/double_double.hpp"
#include "convex/exact/integer.hpp"
#include "convex/vector.hpp"

namespace convex::inline exact_arithmetic {

/// A rational number; the denominator is positive, common factors are allowed.
struct Fraction {
  Integer numerator;
  Integer denominator = 1;
};

/// The exact value of "p/q", an integer or a decimal ("1/3", "-2", "0.1", "1e-3"); none when the text is not
/// a number or the denominator is 0. Decimal exponents beyond ±5000 (and the digits written) count as that:
/// the value is beyond all doubles, or rounds to 0, either way.
std::optional<Fraction> read_fraction(const std::string& text);

/// The value of a finite double.
Fraction fraction(double value);

/// The nearest double, ties to even; infinite when it is beyond all doubles.
double nearest_double(const Fraction& value);
/// The nearest double and the one nearest to what it leaves.
DoubleDouble nearest_pair(const Fraction& value);

/// A vector of fractions over one positive denominator, without a factor common to all.
struct ExactVector {
  IntegerVector numerators;
  Integer denominator = 1;
  Index size() const { return static_cast<Index>(numerators.size()); }
};

ExactVector exact_vector(const std::vector<Fraction>& entries);
/// The exact values of doubles. Throws InvalidInput when one is not finite.
ExactVector exact_vector(const Vector& x);
/// The nearest doubles.
Vector nearest(const ExactVector& x);
/// The nearest pairs.
DoubleDoubleVector nearest_pairs(const ExactVector& x);

/// Rows of one length.
using ExactRows = std::vector<ExactVector>;

/// The exact values of a matrix of doubles, row by row. Throws InvalidInput when one is not finite.
ExactRows exact_rows(const Matrix& M);

/// A matrix over one positive denominator, the least.
struct IntegerMatrix {
  IntegerRows rows;
  Integer denominator = 1;
};
IntegerMatrix over_one_denominator(const ExactRows& rows);

/// The common factor of the entries is taken out; 0 stays 0.
void make_primitive(IntegerVector& v);

}  // namespace convex::inline exact_arithmetic
