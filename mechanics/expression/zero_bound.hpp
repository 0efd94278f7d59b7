#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "convex/exact/fraction_arithmetic.hpp"

namespace mechanics::expression {

/// What is known of a real algebraic number E, so that one closer to 0 than `separation` tells is 0: E = U/L
/// with algebraic integers U and L in a field of at most `degree`, whose conjugates are at most 2^u and 2^l.
/// As the norm of U is a whole number, E = 0 or |E| >= 2^-(u (degree - 1) + l) (Burnikel, Funke, Mehlhorn,
/// Schirra, Schmitt: A separation bound for real algebraic expressions, Algorithmica 55, 2009).
struct AlgebraicNumber {
  double u = 0, l = 0;
  std::set<std::string> radicals;  ///< square roots that generate the field, by name
  std::int64_t order = 1;          ///< with the roots of unity of this order

  double degree() const;
  /// E = 0 or |E| >= 2^-separation().
  double separation() const { return u * (degree() - 1) + l; }
};

/// An angle whose sine and cosine are algebraic: `turns` times pi, and whole multiples of angles of such
/// sines.
struct AlgebraicAngle {
  struct Part {
    AlgebraicNumber cosine, sine;
    std::int64_t times;
  };
  convex::Fraction turns;
  std::vector<Part> parts;
};

/// What is known of a number: the one or the other, or nothing.
struct Algebraic {
  std::optional<AlgebraicNumber> number;
  std::optional<AlgebraicAngle> angle;
};
using KnownAlgebraic = std::shared_ptr<const Algebraic>;  ///< null: nothing

KnownAlgebraic algebraic_fraction(const convex::Fraction&);
KnownAlgebraic algebraic_pi();
KnownAlgebraic algebraic_negative(const KnownAlgebraic&);
KnownAlgebraic algebraic_sum(const KnownAlgebraic&, const KnownAlgebraic&);
/// `left`, `right`: the factors where they are fractions, by which angles may be multiplied.
KnownAlgebraic algebraic_product(const KnownAlgebraic&, const KnownAlgebraic&, const convex::Fraction* left,
                                 const convex::Fraction* right);
/// Of a divisor that is not 0; `right`: it, where it is a fraction.
KnownAlgebraic algebraic_quotient(const KnownAlgebraic&, const KnownAlgebraic&,
                                  const convex::Fraction* right);
/// sqrt, sin, cos, tan, asin, acos, atan, atan2 by their names; `radical`: the name of the operand, or empty.
KnownAlgebraic algebraic_function(const std::string& name, const KnownAlgebraic&, const KnownAlgebraic&,
                                  const std::string& radical);

}  // namespace mechanics::expression
