#pragma once

#include "convex/exact/fraction.hpp"

namespace convex::inline sets::subgradients {

/// Whether the symmetric matrix of integers has an eigenvalue of exactly this multiplicity in [low, high],
/// where its eigenvalues counted with their multiplicities are so many, decided in fractions: the greatest
/// common divisor of p and p', taken that many times less one from the characteristic polynomial p (Faddeev
/// and Le Verrier), changes its sign there.
bool is_multiple_eigenvalue(const IntegerRows& X, Index many, const Fraction& low, const Fraction& high);

}  // namespace convex::inline sets::subgradients
