#pragma once

#include "convex/exact/integer.hpp"

namespace convex {

/// Whether every minor of the rows is below 2^60 by Hadamard's bound: then 128 bits hold every product that
/// fraction-free elimination forms.
bool minors_fit_words(const std::vector<const IntegerVector*>& rows);

/// A vector of minors at right angles to r - 1 rows of r entries; empty when they are dependent. In words of
/// 128 bits (rows that `minors_fit_words`), and in integers of any size.
IntegerVector normal_in_words(const std::vector<const IntegerVector*>& rows, std::size_t r);
IntegerVector normal_in_integers(const std::vector<const IntegerVector*>& rows, std::size_t r);

}  // namespace convex
