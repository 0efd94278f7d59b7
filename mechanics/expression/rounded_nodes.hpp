#pragma once

#include <vector>

#include "convex/exact/fraction.hpp"
#include "mechanics/expression/rounded.hpp"
#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// The text of a literal that is not what it says by up to a radius.
std::string text_with_radius(const std::string& number, double radius);
/// The text of a literal that is a fraction, of many digits, and rounded to a number.
std::string text_of_fraction(const std::string& number, const convex::Fraction& exact);

/// The number of a literal: its radius is 0 where the double is what is written.
Rounded rounded_literal(const Tape& tape, NodeId node);

/// The nodes of a tape that depend on nothing, or on nothing but t, with what rounding may have done to them:
/// decimals count as written, 9.81 is 981/100. The others are left 0.
std::vector<Rounded> rounded_nodes(const Tape& tape, Rounded t = {});

}  // namespace mechanics::expression
