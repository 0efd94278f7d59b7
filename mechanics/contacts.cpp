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
        refuse(constraint, but(constraint, "df/dt") + number_text(df) + " at the state" + at_rest(state) +
                               "; choose velocities that keep it, or let "
                               "`moreau assemble` find the nearest ones");
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
      refuse(constraint, "an impact is due, f = 0 and df/dt = " + number_text(df) + " < 0" + at_rest(state) +
                             "; give the velocity after the impact, or let `moreau simulate` handle it");
    else if (df <= df_zero)
      found.present.push_back(a);
  }
  mistakes.tell();
  return found;
}

}  // namespace mechanics
