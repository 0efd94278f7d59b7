#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/motion/taylor_matrix.hpp"

namespace mechanics::inline motions {

/// What has to be known along a motion to continue it, as expressions of one program. With p = ∂T/∂q' and
/// F = ∂(T - V)/∂q + Q, Lagrange's equations (Moreau 1966, (5)) read
///   dp/dt = F + Σ lambda_a u_a,     df_a/dt = u_a·q' + ∂f_a/∂t = 0 while contact a persists.
struct LagrangeEquations {
  using Slot = expression::Slot;

  explicit LagrangeEquations(const expression::LagrangianModel& model);

  Index coordinates() const { return static_cast<Index>(momentum.size()); }
  Index constraints() const { return static_cast<Index>(constraint.size()); }

  expression::Tape tape;
  /// Group 0: p and df/dt, both of degree 1 in q'; group 1, in addition: F, u, and f
  /// and T - V where they take branches; group 2: f.
  expression::Program program;
  std::vector<Slot> momentum;                            ///< p_i
  std::vector<std::pair<Index, Slot>> force;             ///< F_i where it is not 0 by its structure
  std::vector<Slot> rate;                                ///< df_a/dt
  std::vector<std::vector<std::pair<Index, Slot>>> row;  ///< u_a, zeros by structure left out
  std::vector<Slot> constraint;                          ///< f_a
  std::optional<Slot> branching_lagrangian;              ///< T - V where it takes branches
};

/// The same with the recurrences for its Taylor series.
struct EquationsOfMotion {
  explicit EquationsOfMotion(const expression::LagrangianModel& model);

  LagrangeEquations equations;
  TaylorProgram series;
};

}  // namespace mechanics::inline motions
