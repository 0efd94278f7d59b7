#pragma once

#include "convex/nearest_point/entry_radii.hpp"
#include "mechanics/expression/program.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace mechanics {

/// How far the numbers of a state may be from those that are meant; empty vectors stand for zeros: a state
/// that is what its doubles say.
struct StateRadii {
  double t = 0;
  Vector q, v;
  /// What the text tells of conditions of branches whose sign rounding leaves open.
  std::vector<expression::KnownNode> conditions = {};
};

/// The state with its radii.
expression::RoundedState rounded_state(const State&, const StateRadii&);

/// Of a state that was read from text, whose decimals, fractions, roots … are rounded.
StateRadii state_radii(const LagrangianSystem&, const StateText&, const State&);

/// Of a state whose text is not known: its numbers are a few operations of one.
StateRadii guessed_radii(const State&);

/// How far A, z, U and s, as `inertia` and `contact_rows` evaluate them, may be from those of the mechanism
/// as written, at a state within the radii: decimals, pi and every operation of values and derivatives were
/// rounded. A bound, by the same sweeps over numbers with radii (`expression::Rounded`): what is exact has
/// radius 0. `contacts`: the constraints of K, the rows in their order. Costs several times the evaluation.
convex::EntryRadii data_radii(const LagrangianSystem&, const State&, const StateRadii&,
                              const std::vector<Index>& contacts);

/// Those of U and s alone, by rows (`convex::EntryRadii::by_rows`) in the metric A: what decisions about
/// rows need, at about the price of their evaluation.
convex::DataRadii row_radii(const LagrangianSystem&, const State&, const StateRadii&,
                            const std::vector<Index>& contacts, const convex::Metric& metric);

/// The gradients of these constraints, a row each, without the entries that may be 0 as far as the rounding
/// of the state, of a few operations (`guessed_radii`), and of their own evaluation tell: that of 1 - sin(x)
/// at π/2 is 6e-17 in doubles.
inline constexpr double suspicious_gradient = 0x1p-30;  ///< of what f is the sum of: worth that look
convex::SparseRows gradients_beyond_rounding(const LagrangianSystem&, const State&,
                                             const std::vector<Index>& constraints);

/// How far f_a and df_a/dt, as `constraint_rates` evaluates them, may be from those as written.
struct RateRadii {
  Vector f, df;
};
RateRadii rate_radii(const LagrangianSystem&, const State&, const StateRadii&);

/// A number for each equation, and how far it may be from the one as written.
struct RoundedVector {
  Vector value, radius;
};

/// z + Σ lambda_a u_a - A q'' and u_a·q'' - s_a as written, for the numbers q'' and lambda given (by contact
/// of K), at a few times the price of an evaluation, without a radius for every entry. They are evaluated as
/// they stand in the text, not from the entries of A and U: what the rounding of an entry moved (1 + 1e-8)
/// is in the value, where the text keeps its terms apart.
struct EquationsAsWritten {
  RoundedVector balance;  ///< n
  RoundedVector rows;     ///< by contact of K
};
EquationsAsWritten equations_as_written(const LagrangianSystem&, const State&, const StateRadii&,
                                        const std::vector<Index>& contacts, const Vector& q2,
                                        const Vector& lambda);

}  // namespace mechanics
