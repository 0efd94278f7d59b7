#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mechanics/lagrangian_system.hpp"
#include "mechanics/motion/held_rows.hpp"
#include "mechanics/motion/inertia_columns.hpp"
#include "mechanics/motion/inertia_factor.hpp"
#include "mechanics/motion/lagrange_equations.hpp"
#include "mechanics/motion/taylor_magnitude.hpp"
#include "mechanics/motion/taylor_series.hpp"
#include "mechanics/state.hpp"

namespace mechanics::inline motions {

/// Whether some constraints, or switches, have this one among them.
inline bool is_among(const std::vector<Index>& all, Index a) {
  return std::find(all.begin(), all.end(), a) != all.end();
}

/// Contacts at the beginning of an arc. `held` persist for certain, in the order in which their multipliers
/// are to be determined where they depend on each other; `open` have f = df/dt = 0, and it is asked whether
/// they persist. `unloaded`: those of `open` whose multiplier has come to 0 here; up to `left` it counts as
/// 0.
struct ContactQuestion {
  struct Unloaded {
    Index constraint;
    double left;
  };
  std::vector<Index> held, open;
  std::vector<Unloaded> unloaded = {};
};

/// What the right limit of the motion says of them: those that persist, first the ones with a multiplier
/// that is not 0, and those that open, with the order of the first derivative of f that is not 0.
struct ContactAnswer {
  struct Opening {
    Index constraint;
    int order;
  };
  std::vector<Index> persist;
  std::vector<Opening> open;
  std::vector<Index> excluding;  ///< constraints that no acceleration satisfies together; else empty
};

/// The Taylor series of a motion at a state, q(t + τ) = Σ q_k τ^k and the multipliers of the contacts that
/// persist, found order by order from Lagrange's equations.
///
/// Order k + 1 of v = q' and order k of lambda: let p⁰ and g⁰ be the coefficients k + 1 of p = ∂T/∂q' and of
/// df/dt when v_(k+1) is taken as 0. Both are of degree 1 in q', so that with A and U at the state itself
///   A v_(k+1) + p⁰ = (F_k + Σ_a Σ_(j<=k) lambda_(a,j) u_(a,k-j)) / (k + 1),     U v_(k+1) + g⁰ = 0,
/// a linear system with one and the same matrix for every order.
///
/// Where it is open whether a contact persists, the same system with complementarity, 0 <= lambda ⟂ slack >=
/// 0, decides at the first order at which one of them is not 0: at order 0 this is Gauss' problem itself.
class Expansion {
 public:
  /// `system` must outlive it.
  Expansion(const LagrangianSystem& system, int order);

  /// Coefficients 0 at a state: f, df/dt, A and what follows from them.
  void set(const State& state);
  /// f, df/dt and the arguments of switches at a state; nothing else is known there.
  void look_at(const State& state);
  /// f and df/dt alone.
  void look_at_constraints(const State& state);
  /// The arguments of switches alone, whether all else has a value or not.
  void look_at_arguments(const State& state);
  const State& state() const { return state_; }
  const convex::Metric& inertia() const;
  /// Takes note that the motion has come by here: what rounding may have made of a coordinate near 0 is that
  /// of the sizes that it has had.
  void note_reach(const State& at);
  /// The largest |q_i'| that it has come by with.
  double fastest(Index i) const { return fastest_[equations_.program.velocity(index(i))]; }
  /// Whether t itself enters something.
  bool uses_time() const { return steps_.uses_time; }
  /// ||x||_A.
  double norm(const Vector& x) const;
  /// ||q_k||_A by order, of the first orders and of the last ones that are not 0; else 0.
  void sizes(std::vector<double>& of_order) const;
  double f(Index a) const { return series_[equations_.constraint[index(a)]][0]; }
  double rate(Index a) const { return series_[equations_.rate[index(a)]][0]; }
  /// ∂f_a/∂t = df_a/dt - u_a·v.
  double drift(Index a) const;
  Vector row(Index a) const;
  /// The same in memory that is there.
  void row(Index a, Vector& u) const;
  /// Whether ∂f/∂q is 0 up to half the digits of what it is the sum of, as that of y - sin(y) near 0.
  bool has_lost_gradient(Index a);
  /// From here on the gradients of these constraints count as 0.
  void take_gradients_for_zero(std::vector<Index> constraints) { zero_rows_ = std::move(constraints); }
  const std::vector<Index>& gradients_taken_for_zero() const { return zero_rows_; }
  /// Where a root or a power is taken of what rounding has left of a 0, as that of |v| is where v turns, it
  /// is one of 0 at this state, if all is finite then. Returns whether there is another one of that kind.
  bool take_bases_for_zero();
  /// Where that was done: the switches beside 0 whose arguments rounding may have made as well, and how much.
  std::vector<std::pair<Index, double>> arguments_left_by_rounding();
  /// The gradient of f_a is 0 here, though f_a has q in it.
  bool is_singular(Index a) const { return !equations_.row[index(a)].empty() && row(a).isZero(0); }
  /// The largest of |u_i v_i| and |∂f/∂t|: what df/dt is the sum of.
  double rate_scale(Index a) const;
  /// The largest of |u_i q_i| and |f|: what f is about the sum of.
  double position_scale(Index a) const;
  /// ||r||_(A⁻¹) of the forces without reactions, once `expand` was asked.
  double force_norm() const;
  /// These forces.
  const Vector& force() const { return force_; }
  /// ∂T/∂q'.
  Vector momentum() const;
  /// ∂T/∂q'·x.
  double momentum_along(const Vector& x) const;
  /// T - V where it takes branches, else 0.
  bool has_branching_energy() const { return equations_.branching_lagrangian.has_value(); }
  double lagrangian() const {
    return equations_.branching_lagrangian ? series_[*equations_.branching_lagrangian][0] : 0;
  }
  /// Rows held with equality at this state.
  HeldRows held_rows(const std::vector<Index>& constraints) const;
  /// Whether the gradient of f_a is so nearly one of these, or a combination of theirs, that f does not tell.
  bool is_nearly_implied(Index a, std::vector<Index> constraints) const;

  /// q'' at the state, and the multipliers, while these constraints are held.
  HeldRows::Answer acceleration(const std::vector<Index>& held);
  /// Open contacts of the last question whose slack or multiplier was neither clearly 0 nor clearly not.
  const std::vector<Index>& in_doubt() const { return in_doubt_; }
  /// The higher coefficients, and who persists.
  ContactAnswer expand(const ContactQuestion& contacts);

  /// The order from which on a derivative of the motion is not finite at the state, as that of a drag |v| v
  /// at rest: so far the series of the last `expand` go, or without its terms. 0 where there is none.
  int cut() const {
    const int without_bound = series_.without_bound();
    return cut_ > 0 || without_bound == 0 ? cut_ : without_bound + 2;
  }
  /// Whether they end before that order.
  bool ends_early() const { return cut_ > 0; }
  /// Throws InvalidInput, saying so, and what follows from it.
  [[noreturn]] void refuse_cut(std::string_view besides) const;

  int order() const { return order_; }
  Index coordinates() const { return equations_.coordinates(); }
  Index constraints() const { return equations_.constraints(); }
  /// Coefficients of q_i and of f_a, 0 to `order`, and of lambda_a, 0 to order - 2 (zeros where the contact
  /// does not persist).
  std::span<const double> position(Index i) const { return series_[static_cast<expression::Slot>(i)]; }
  std::span<const double> constraint(Index a) const { return f_of(a); }
  std::span<const double> multiplier(Index a) const {
    return {lambda_.data() + a * (order_ - 1), static_cast<std::size_t>(order_ - 1)};
  }
  /// Arguments whose signs choose a branch, coefficients 0 to order - 2.
  std::size_t switches() const { return steps_.switches.size(); }
  std::span<const double> switch_argument(std::size_t k) const {
    return series_[steps_.switches[k].argument].first(static_cast<std::size_t>(order_ - 1));
  }
  /// So many of these, from the first one on, do not hang on derivatives without a bound.
  std::size_t known_of_argument(std::size_t k) const {
    return static_cast<std::size_t>(std::min(order_ - 1, series_.known(steps_.switches[k].argument)));
  }
  /// What functions such as exp and sin are taken of, coefficients 0 to `order`.
  const std::vector<FunctionArgument>& arguments() const { return steps_.arguments; }
  std::span<const double> argument(const FunctionArgument& one) const { return series_[one.argument]; }
  /// Up to here rounding may have made df_a/dt, and the multipliers of contacts held.
  double rounding_of_rate(Index a);
  /// df_a/dt likewise, where impacts and forces may have brought the velocities down from what they were.
  double rounding_of_rate_so_far(Index a);
  /// What rounding may have made so of f and df/dt, by constraint.
  struct Roundings {
    Vector f, rate;
  };
  Roundings roundings_so_far();
  /// What df/dt, and what f, is the sum of.
  double magnitude_of_rate(Index a);
  double magnitude_of_constraint(Index a);
  Vector rounding_of_multipliers(const std::vector<Index>& held);
  /// And ||q''||_A at a state, of the terms of the forces, after `acceleration`.
  double rounding_of_acceleration() { return rounding(0) * norm(magnitudes({}, 0).velocity); }
  /// Up to here rounding may have made the coefficients of these arguments, of so many orders, after
  /// `expand`.
  std::vector<std::vector<double>> rounding_of_switches(const std::vector<Index>& which, int orders);
  /// The same of the coefficients of df/dt.
  std::vector<std::vector<double>> rounding_of_rates(const std::vector<Index>& which, int orders);
  /// The same of the argument itself, at a state.
  double rounding_of_argument(std::size_t k);
  /// This part of it at a state whose numbers are as they were given, each rounded once.
  double part_as_given() const;
  /// Whether one of the arguments may jump, as at a pole, or have a kink, of which its series do not tell.
  bool may_jump() const { return may_jump_; }
  /// Whether that argument, or that f, has a quotient that may be nothing beside a number far from its pole.
  bool argument_may_hide(std::size_t k) const { return may_hide_[k]; }
  bool constraint_may_hide(Index a) const { return may_hide_[switches() + index(a)]; }
  /// Whether both arguments of an atan2 are 0 but for rounding at a state, so that nothing tells the angle,
  /// and with it a branch.
  bool has_open_angle();
  /// Whether a coordinate stands in that argument.
  bool depends_on_position(std::size_t k) const { return depends(k, expression::on_coordinates); }
  /// Whether a velocity does.
  bool depends_on_velocity(std::size_t k) const { return depends(k, expression::on_velocities); }
  /// Whether t itself does.
  bool depends_on_time(std::size_t k) const { return depends(k, expression::on_time); }
  double& branch(std::size_t k) { return series_.branches()[k]; }
  double branch(std::size_t k) const { return series_.branches()[k]; }
  /// "|x|" as it was written, and where.
  const Switch& switch_of(std::size_t k) const { return steps_.switches[k]; }

 private:
  std::span<const double> f_of(Index a) const {
    return {f_.data() + a * (order_ + 1), static_cast<std::size_t>(order_ + 1)};
  }
  /// More than any series has coefficients.
  static constexpr int most_orders = 64;
  static std::size_t index(Index a) { return static_cast<std::size_t>(a); }
  bool depends(std::size_t k, expression::Dependence on) const;
  void take(const State& state);
  void find_inertia();
  void take_branches();
  bool is_finite() const;
  bool find_bases_at_zero();
  void begin();
  bool begin_order(int k);
  double magnitude_of(expression::Slot series);
  HeldRows::Answer solve_held(const std::vector<Index>& held, std::optional<HeldRows>& rows) const;
  double left_of_push(Index a, const Vector& u) const;
  /// Whether no open contact pushes at order k, for v without their multipliers satisfies them: then those
  /// with a slack are settled.
  bool leaves_open(const Vector& v, const std::vector<Index>& persist, const std::optional<HeldRows>& rows,
                   std::vector<Index>& open, ContactAnswer& answer, int k);
  /// The higher coefficients, with those contacts pushing that `may_push_` allows.
  ContactAnswer expand_once(const ContactQuestion& contacts);
  /// Solves order k with complementarity for the open contacts, and settles those that this order decides.
  Vector choose(std::vector<Index>& persist, std::vector<Index>& open, ContactAnswer& answer, int k);
  /// Whether another contact may begin to push in the place of one that the last order contradicts.
  bool exchange(const ContactQuestion& contacts, const ContactAnswer& answer);
  /// The first order at which the contact has a multiplier.
  int first_push(Index a) const;
  /// What df/dt of these constraints and v are the sums of, at order k of the question.
  struct Magnitudes {
    Vector rates, velocity;
    /// What u·v is the sum of, u the gradient of a constraint.
    double along(const Vector& u) const { return u.cwiseAbs().dot(velocity); }
  };
  Magnitudes magnitudes(const std::vector<Index>& constraints, int k);
  std::vector<std::vector<double>> rounding_of_series(const std::vector<expression::Slot>& which, int orders);
  /// A constraint, s of df/dt at an order, and what that is the sum of.
  struct Asked {
    Index constraint;
    double s, rate;
  };
  struct Slack {
    double slack, left;  ///< what rounding may have made of it
    double times;        ///< the gradient of the constraint over that of the one held
  };
  /// The slack of a beside b, which is held, at order k with v = x. Where their gradients are parallel but
  /// for rounding it is the difference of what they ask for, times s_b - s_a: neither x nor what is constant
  /// in the gradients rounds it. Nothing where they are not.
  std::optional<Slack> slack_beside(const Asked& a, const Asked& b, const Vector& x, const Magnitudes& of,
                                    int k);
  /// Notes that a cannot hold beside b, which does.
  void contradict(Index a, Index b, double times, ContactAnswer& answer) {
    answer.excluding = {a, b};
    weights_ = {1, -times};
  }
  double next_coefficient(expression::Slot coordinate, int k) const;
  Magnitudes magnitudes_of_order(const std::vector<Index>& constraints, int k);
  /// What rounding makes of a coefficient of order k, as a part of its magnitude.
  double rounding(int k) const;
  /// Without that of the state, which is one state for all.
  double rounding_of_operations(int k) const;
  void give_velocity(int k, const Vector& v);
  void give_multipliers(int k, const std::vector<Index>& constraints, const Vector& lambda);
  Vector missing_rate(const std::vector<Index>& constraints) const;
  bool ends_by(int k) const;
  bool expand_free();
  void find_constraints();

  const LagrangianSystem& system_;
  const LagrangeEquations& equations_;
  const TaylorSteps& steps_;
  int order_;
  int cut_ = 0;
  TaylorSeries series_;
  State state_;
  bool has_branches_ = false;
  convex::Matrix small_, found_;  // A of few coordinates, and where it is looked for
  InertiaFactor factor_;          // the same
  mutable std::optional<convex::Metric> A_;
  InertiaColumns columns_;
  Vector r_, force_;            // what velocities of the order looked for are solved from; that of order 0
  std::vector<double> lambda_;  // by constraint and order
  std::vector<double> f_;       // likewise
  TaylorMagnitude magnitude_;   // while it is open who persists
  bool magnitude_is_begun_ = false;
  bool may_jump_ = false;       // an argument of a switch
  std::vector<bool> may_hide_;  // by switch, and by constraint after them
  std::vector<std::pair<expression::Slot, expression::Slot>> choosing_angles_;  // y, x of each atan2 in them
  std::vector<double> fastest_;  // by variable: the velocities that the motion has had
  int magnitudes_found_ = 0;     // orders of the question
  convex::Matrix inverse_;       // |A⁻¹| of its entries, for few coordinates
  Vector unit_norms_;            // ||e_i||_(A⁻¹), for many
  std::vector<Index> in_doubt_;
  std::vector<Index> zero_rows_;
  std::vector<ContactQuestion::Unloaded> unloaded_;
  std::vector<Index> pushing_;  // the constraints with a multiplier so far
  /// Of the contacts that begin to push at an order, where their gradients leave a choice.
  struct MayPush {
    int order;
    std::vector<Index> contacts;
    bool operator==(const MayPush&) const = default;
  };
  std::vector<MayPush> may_push_;
  std::vector<std::vector<MayPush>> exchanged_;  // what it was so far
  std::vector<double> weights_;  // of constraints that exclude each other: Σ w_a u_a = 0, w·s > 0
};

}  // namespace mechanics::inline motions
