#pragma once

#include "convex/exact_program/exact_gram.hpp"

namespace pybind11 {
class handle;
class object;
}  // namespace pybind11

namespace python {

/// Numbers at their exact values: floats as they are, integers, fractions.Fraction, texts such as "1/3".
/// Throws InvalidInput with `name` where it is something else, or not finite.
convex::Fractions fractions_of(pybind11::handle numbers, const char* name);

/// A metric of n entries at its exact values; None for the identity.
convex::ExactGram gram_of(const pybind11::object& W, convex::Index n);

/// Fractions as fractions.Fraction, in a list.
pybind11::object fraction_list(const convex::Fractions& x);

}  // namespace python
