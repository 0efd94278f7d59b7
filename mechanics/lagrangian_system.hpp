#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "convex/mistakes.hpp"
#include "mechanics/lagrangian_text.hpp"
#include "mechanics/system.hpp"

namespace mechanics {

namespace expression {
struct LagrangianModel;
}
inline namespace motions {
struct EquationsOfMotion;
}

/// A system given by the text of T, V, Q and the constraints. Derivatives are exact: automatic
/// differentiation, forward over reverse (Griewank and Walther 2008, ch. 3 and 5), nothing is approximated by
/// differences. Immutable: its functions may be called from several threads at once.
class LagrangianSystem : public System {
 public:
  explicit LagrangianSystem(std::unique_ptr<const expression::LagrangianModel> model);
  ~LagrangianSystem() override;

  const std::vector<std::string>& coordinates() const override;
  const std::vector<Constraint>& constraints() const override;
  Inertia inertia(const State& state) const override;
  ConstraintRates constraint_rates(const State& state) const override;
  ContactRows contact_rows(const State& state, const std::vector<Index>& constraints) const override;
  Vector second_rates(const State& state, const Vector& q2) const override;
  double energy(const State& state) const override;
  double kinetic_energy(const State& state) const;

  /// The state that a text gives: every position, velocities (0 where missing) and t (0 where missing), as
  /// expressions in the parameters and t. InvalidInput, with the place, for what is missing, unknown or not
  /// finite.
  State state(const StateText& text) const;
  /// The tape of all its expressions.
  const expression::LagrangianModel& model() const { return *model_; }
  /// What a motion is found from, as expressions: derived when it is first asked for, once for all motions.
  const EquationsOfMotion& equations_of_motion() const;

 private:
  std::unique_ptr<const expression::LagrangianModel> model_;
  mutable std::once_flag is_derived_;
  mutable std::unique_ptr<const EquationsOfMotion> equations_;
};

/// Parses the text, expands its families and checks it. InvalidInput, with the place, for whatever is wrong
/// in it; what is wrong in the expressions of the state, too, is told with that.
std::unique_ptr<const LagrangianSystem> lagrangian_system(const LagrangianText& text,
                                                          const StateText& state = {});

/// Adds what is wrong in the expressions of the text and the state, each by itself: its form and its names.
void gather_mistakes(const LagrangianText& text, const StateText& state, convex::Mistakes& mistakes);

}  // namespace mechanics
