#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline dual_active_set {

/// Rows that depend on each other: independent ones, `basic`, and the others with their expansions in them,
/// u_p = Σ T(k, p) u_k. A coefficient that the radii of the rows may make of 0 is 0.
struct Dependence {
  std::vector<Index> basic, dependent;
  Matrix T;
  /// An estimate of 1 / (smallest singular value) of the basic rows, each of length 1.
  double inverse_norm = 1;
};

/// The dependences among the tight rows, one for each group of rows that are tied to each other; rows that
/// depend on no others and are needed for none are left out. `basis`: independent tight rows, which come
/// first. None when a group that hangs together by its coordinates is too large for a dense factor.
std::optional<std::vector<Dependence>> dependences(const NearestPointProblem&,
                                                   const std::vector<Index>& basis,
                                                   const std::vector<Index>& tight);

/// An estimate of 1 / (smallest singular value) of independent rows, each of length 1; 1 where they are too
/// many for a factor that nobody needs to solve the problem.
double inverse_norm_of_rows(const NearestPointProblem&, const std::vector<Index>& rows);

/// The coefficients of rows with Σ mu_a u_a = 0.
using NullVector = std::vector<std::pair<Index, double>>;

/// A basis of {mu : Uᵀmu = 0} over the tight rows: e_p - Σ T(k, p) e_k for every dependent row p, in order.
std::vector<NullVector> null_space(const std::vector<Dependence>&);

}  // namespace convex::inline dual_active_set
