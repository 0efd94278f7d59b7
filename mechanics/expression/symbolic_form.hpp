#pragma once

#include <map>
#include <optional>
#include <string>

#include "convex/exact/fraction_arithmetic.hpp"

namespace mechanics::expression {

using convex::Fraction;

/// A number as constant + Σ c_k atom_k with rational c_k. An atom is named by what it is, such as "pi",
/// "cos(1/3)" or "(pi)*(cos(1/3))": equal names are equal numbers, so that forms without atoms are fractions
/// and equal forms differ by exactly 0. The converse does not hold: nothing is concluded from different
/// forms.
struct SymbolicForm {
  Fraction constant;
  std::map<std::string, Fraction> atoms;  ///< coefficients that are not 0
};

SymbolicForm sum(const SymbolicForm&, const SymbolicForm&);
SymbolicForm scaled(const SymbolicForm&, const Fraction& factor);
bool operator==(const SymbolicForm&, const SymbolicForm&);

/// An atom with that coefficient.
SymbolicForm atom(const std::string& name, const Fraction& coefficient);

/// The product of two numbers: cos(F)² is 1 - sin(F)², all else is an atom with its factors in order.
SymbolicForm product(const SymbolicForm&, const SymbolicForm&);
/// c when a = c b for a fraction c, else an atom. b stands for a number that is not 0.
SymbolicForm quotient(const SymbolicForm& a, const SymbolicForm& b);

/// sin, cos, tan, asin, … of a number: odd and even functions take an argument whose first coefficient is
/// positive; sin, cos and tan are fractions at the multiples of pi where they are (Niven 1956,
/// corollary 3.12), sin of asin(p/q) and cos of acos(p/q) are p/q, the other one of the two where 1 - p²/q²
/// is a square.
SymbolicForm function_form(const std::string& name, const SymbolicForm& argument);

/// None when the form is too long to be worth its while.
std::optional<std::string> written(const SymbolicForm&);

}  // namespace mechanics::expression
