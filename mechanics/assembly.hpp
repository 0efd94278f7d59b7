#pragma once

#include <vector>

#include "mechanics/lagrangian_system.hpp"

namespace mechanics {

/// What is asked of an assembly.
struct AssemblyQuestion {
  std::vector<Index> contacts;  ///< one-sided constraints that are to be in contact
  std::vector<Index> held;      ///< coordinates that keep their position and velocity
};

enum class AssemblyStatus { solved, infeasible, gave_up };

/// The nearest state that a mechanism can have. `moved`: the distance of the positions in the kinetic metric
/// of the guess; residual: the largest |f| and |df/dt| that should be 0, and what is violated, relative to
/// their scales.
struct Assembly {
  AssemblyStatus status = AssemblyStatus::gave_up;
  State state;
  double residual = 0, moved = 0;
  std::vector<Index> fighting;  ///< infeasible: constraints of which no search met all
  bool proved = false;          ///< that no state does: they exclude each other
  bool are_rates = false;       ///< all hold at the position found; it is their df/dt that no velocity meets
  /// gave_up: two-sided constraints and contacts whose gradient vanishes at the position found, and which the
  /// velocity leaves to second order.
  std::vector<Index> singular;
};

/// A position locally nearest to that of the guess, in its kinetic metric A, with f_a = 0 for two-sided
/// constraints and contacts and f_a >= 0 for all others; then the nearest velocity in the same metric with
/// df_a/dt = 0 for the former, and df_a/dt >= 0 for those of the others that have f_a = 0. Sequential
/// quadratic programming with exact derivatives (Nocedal and Wright 2006, chapter 18); where a linearised
/// problem has no solution, Levenberg's least squares of what is violated. From other starts when the guess
/// leads nowhere.
Assembly assemble(const LagrangianSystem&, const State& guess, const AssemblyQuestion&);

}  // namespace mechanics
