#pragma once

#include <optional>

#include "convex/nearest_point/proof/exact_problem.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace mechanics {

/// Gauss' problem over the rationals, straight from the text of a mechanism and its state: decimals and
/// fractions count as written (9.81 is 981/100), nothing is rounded anywhere.
struct ExactTextProblem {
  convex::ExactProblem problem;
  bool contacts_hold = true;  ///< f_a = 0 and df_a/dt = 0 exactly for every contact given
};

/// `contacts`: the constraints of K, in order. None when a function's value there is no fraction, or a
/// derivative does not exist, or the system has more than `most_exact_coordinates` coordinates. Throws
/// InvalidInput when A is not positive definite.
std::optional<ExactTextProblem> exact_from_text(const LagrangianSystem&, const StateText&,
                                                const std::vector<Index>& contacts);

inline constexpr std::size_t most_exact_coordinates = 40;

}  // namespace mechanics
