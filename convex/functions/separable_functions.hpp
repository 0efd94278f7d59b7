#pragma once

#include "convex/gamma0/function.hpp"

/// Smooth functions of each entry by itself, summed; +inf outside the domain named, closed hull meant (0 log
/// 0 = 0). Each makes its conjugate by rule. InvalidInput on a parameter outside its range.
namespace convex::inline named_functions {

/// Σ x log x, x >= 0. Conjugate: Σ e^(v-1).
Function entropy();
/// Σ x log(x/r) - x + r, x >= 0; r: the reference, >= 0, one for all entries or one each (r = 0: x = 0).
/// Conjugate: Σ r (e^v - 1) (Kullback and Leibler 1951; Chaux et al. 2007).
Function kullback_leibler(double reference = 1);
Function kullback_leibler(const Vector& reference);
/// Σ e^x. Conjugate: Σ v log v - v.
Function exponential();
/// Σ weight (e^x - 1), weight >= 0. Conjugate: kullback_leibler(weight).
Function expm1(double weight = 1);
Function expm1(const Vector& weight);
/// Σ offset - log x, x > 0. Conjugate: Σ (-1 - offset) - log(-v).
Function log_barrier(double offset = 0);
/// Σ log(1 + e^x). Conjugate: binary_entropy().
Function logistic();
/// Σ x log x + (1-x) log(1-x), 0 <= x <= 1. Conjugate: logistic().
Function binary_entropy();
/// Σ |x|^p, 1 <= p < inf. Conjugate: (p-1) Σ |v/p|^(p/(p-1)) for p > 1.
Function power(double p);
/// Σ x^-q, x > 0; q > 0. Conjugate: -(1+q) Σ (-v/q)^(q/(1+q)), v <= 0.
Function inverse_power(double q);
/// -Σ x^r, x >= 0; 0 < r < 1. Conjugate: (1-r) Σ (-v/r)^(-r/(1-r)), v < 0.
Function negative_power(double r);

}  // namespace convex::inline named_functions
