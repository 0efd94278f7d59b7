#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convex/invalid_input.hpp"
#include "mechanics/state.hpp"

namespace mechanics {

/// A constraint f(q, t) >= 0, or f(q, t) = 0 when it is two-sided; `place` is where it was written, if
/// anywhere.
struct Constraint {
  std::string name;
  bool two_sided = false;
  std::optional<convex::Place> place;
  std::string read_as = {};  ///< "y = 0" where the relation is a power of it, and f and df/dt are those of y
};

/// Lagrange's equations without reactions, A q'' = z, at a state (Moreau 1966, (8)).
/// A = ∂²T/∂q'∂q': n×n, symmetric; z = Q - ∂V/∂q + ∂T/∂q - (∂²T/∂q'∂q) q' - ∂²T/∂q'∂t.
struct Inertia {
  convex::SparseMatrix A;
  Vector z;
};

/// f_a and df_a/dt of every constraint at a state, with the scales that a tolerance on them refers to:
/// f_scale_a is the largest |summand| of f_a as written, df_scale_a the largest of |u_i q'_i| and |∂f_a/∂t|;
/// both are at least 1, the one absolute scale there is.
struct ConstraintRates {
  Vector f, df;
  Vector f_scale, df_scale;
};

/// The rows of d²f_a/dt² = u_a·q'' - s_a for chosen constraints, in their order (Moreau 1966, (7)).
/// U: one row per constraint, u_a = ∂f_a/∂q; s_a = -(q'·f_qq q' + 2 f_qt·q' + f_tt).
struct ContactRows {
  convex::SparseRows U;
  Vector s;
};

/// A frictionless mechanical system by its Lagrangian data: all that equations (4)-(8) of Moreau 1966 need.
/// Every function throws InvalidInput, naming the expression, where a value or a derivative is not finite.
class System {
 public:
  virtual ~System() = default;
  /// Names of the coordinates q, in order.
  virtual const std::vector<std::string>& coordinates() const = 0;
  /// The constraints, in order.
  virtual const std::vector<Constraint>& constraints() const = 0;
  virtual Inertia inertia(const State&) const = 0;
  virtual ConstraintRates constraint_rates(const State&) const = 0;
  virtual ContactRows contact_rows(const State&, const std::vector<Index>& constraints) const = 0;
  /// d²f_a/dt² of every constraint when the acceleration is `q2`.
  virtual Vector second_rates(const State&, const Vector& q2) const = 0;
  /// T + V at the state.
  virtual double energy(const State&) const = 0;
};

}  // namespace mechanics
