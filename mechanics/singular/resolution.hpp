#pragma once

#include <functional>

#include "mechanics/gauss_solution.hpp"
#include "mechanics/singular/singular_state.hpp"

namespace mechanics::inline singular_states {

/// Gauss' problem with all the equations that its answer at the state needs.
struct Resolution {
  convex::NearestPointProblem problem;  ///< the equations of third derivatives are its last rows
  std::vector<AddedRow> added;
  /// Rows are not those of the state's doubles: a gradient that vanishes or that others make up was settled
  /// or left out. Nothing that is proved of these rows is proved of the mechanism.
  bool is_settled = false;
  std::vector<Warning> warnings;
};

/// Solves until higher derivatives agree with the answer (docs/theory.md, B.8). `solve` is called once and
/// then after every addition; the answer that stands is the last one. Throws InvalidInput where higher
/// derivatives refuse the state.
/// radii: of the state's numbers.
Resolution resolve(const LagrangianSystem&, const State&, const StateRadii& radii, const GaussProblem&,
                   const std::function<const GaussSolution&(const convex::NearestPointProblem&)>& solve);

/// The same for whatever forces act at the state, and whatever one-sided contacts do to them: all equations
/// that some acceleration with the two-sided rows does not satisfy. The warnings are those of what is left
/// undecided alone; of the equations, `added` tells.
Resolution resolve_for_every_force(const LagrangianSystem&, const State&, const StateRadii& radii,
                                   const GaussProblem&);

}  // namespace mechanics::inline singular_states
