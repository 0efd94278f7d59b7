#include "mechanics/contacts.hpp"

#include <cmath>

#include "convex/mistakes.hpp"
#include "mechanics/number_text.hpp"

namespace mechanics {
namespace {

/// "two-sided, but f", or of what is looked at in its place.
std::string but(const Constraint& constraint, const std::string& rate) {
  if (constraint.read_as.empty()) return "two-sided, but " + rate + " = ";
  return "two-sided, and read as " + constraint.read_as + ", of which it is a power, but " + rate + " = ";
}

/// Velocities that are left out of a file are 0, which may be what is wrong.
const char* at_rest(const State& state) { return state.v.isZero(0) ? " with all velocities 0" : ""; }

/// Of each constraint, whether its gradient is 0 at the state: df/dt is then the same for all velocities.
std::vector<bool> have_no_gradient(const System& system, const State& state,
                                   const std::vector<Index>& constraints) {
  std::vector<bool> found(constraints.size(), false);
  try {
    const convex::SparseRows U = system.contact_rows(state, constraints).U;
    for (std::size_t k = 0; k < constraints.size(); ++k)
      found[k] = U.row(static_cast<Index>(k)).squaredNorm() == 0;
  } catch (const convex::InvalidInput&) {
    // where a second derivative does not exist the gradient is not known here
  }
  return found;
}

/// What is wrong with df/dt of a constraint that holds.
std::string wrong_rate(const Constraint& constraint, const State& state, double df, bool has_no_gradient) {
  const std::string rate = number_text(df);
  if (has_no_gradient)
    return (constraint.two_sided ? but(constraint, "df/dt") : "f = 0 and df/dt = ") + rate +
           (constraint.two_sided ? "" : " < 0") +
           " whatever the velocities, for its gradient is 0 at the state; choose another position or t, or "
           "change the constraint";
  if (constraint.two_sided)
    return but(constraint, "df/dt") + rate + " at the state" + at_rest(state) +
           "; choose velocities that keep it, or let `moreau assemble` find the nearest ones";
  return "an impact is due, f = 0 and df/dt = " + rate + " < 0" + at_rest(state) +
         "; give the velocity after the impact, or let `moreau simulate` handle it";
}

}  // namespace

Contacts contacts(const System& system, const State& state, const Vector& tolerance, Impending impending) {
  const auto m = static_cast<Index>(system.constraints().size());
  if (tolerance.size() != m || !(tolerance.array() >= 0).all())
    throw convex::InvalidInput("contact_tolerance: give " + std::to_string(m) +
                               " numbers that are not negative, one per constraint");
  if (!std::isfinite(state.t) || !state.q.allFinite() || !state.v.allFinite())
    throw convex::InvalidInput("state: a number is not finite; give finite numbers");
  Contacts found;
  found.rates = system.constraint_rates(state);
  const auto& constraints = system.constraints();
  convex::Mistakes mistakes;
  std::vector<Index> unkept;
  const auto refuse = [&](const Constraint& constraint, const std::string& what) {
    mistakes.add(convex::InvalidInput("constraint " + constraint.name + ": " + what, constraint.place));
  };
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    const Index a = static_cast<Index>(k);
    const Constraint& constraint = constraints[k];
    const double f = found.rates.f[a], df = found.rates.df[a];
    const double f_zero = tolerance[a] * found.rates.f_scale[a],
                 df_zero = tolerance[a] * found.rates.df_scale[a];
    if (constraint.two_sided) {
      if (!(std::abs(f) <= f_zero))
        refuse(constraint, but(constraint, "f") + number_text(f) +
                               " at the state; move the position so that it holds, or let "
                               "`moreau assemble` find the nearest one");
      else if (!(std::abs(df) <= df_zero))
        unkept.push_back(a);
      found.present.push_back(a);
      continue;
    }
    if (!(f >= -f_zero)) {
      refuse(constraint, "penetrated, f = " + number_text(f) +
                             " < 0; move the position so that f >= 0, raise contact_tolerance, or let "
                             "`moreau assemble` find the nearest state");
      continue;
    }
    if (f > f_zero) continue;
    if (df < -df_zero && impending == Impending::allowed)
      found.closing.push_back(a);
    else if (df < -df_zero)
      unkept.push_back(a);
    else if (df <= df_zero)
      found.present.push_back(a);
  }
  if (!unkept.empty()) {
    const std::vector<bool> are_flat = have_no_gradient(system, state, unkept);
    for (std::size_t k = 0; k < unkept.size(); ++k) {
      const Constraint& constraint = constraints[static_cast<std::size_t>(unkept[k])];
      refuse(constraint, wrong_rate(constraint, state, found.rates.df[unkept[k]], are_flat[k]));
    }
  }
  mistakes.tell();
  return found;
}

}  // namespace mechanics
