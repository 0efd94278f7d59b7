#pragma once

#include <vector>

#include "convex/vector.hpp"

namespace convex::prox_formulas {

/// A point that is constant on runs of neighbours: run k is the entries from first[k] up to first[k + 1], the
/// last one up to the end.
struct Blocks {
  Vector x;
  std::vector<Index> first;
};

/// The derivative of a point whose runs are means of z with weights d, up to constants: J_ij = d_j / Σ_run d.
Matrix blocks_jacobian(const Blocks&, const Vector& d);

/// D(z - x) for the exact x behind the rounded one, whose runs have Σ d_i (z_i - x_i) = sum_of_run[k]: the
/// sums hold to the rounding of the result itself, however far away z is.
Vector blocks_covector(const Blocks&, const Vector& z, const Vector& d, const Vector& sum_of_run);

}  // namespace convex::prox_formulas
