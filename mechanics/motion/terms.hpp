#pragma once

#include <span>

namespace mechanics::inline motions {

/// Σ |c_k| h^k from k = 1, h >= 0.
double sum_of_terms(std::span<const double> c, double h);

/// The largest |c_k| h^k from k = 1, h >= 0.
double largest_term(std::span<const double> c, double h);

}  // namespace mechanics::inline motions
