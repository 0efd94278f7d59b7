#include "mechanics/motion/impact.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "mechanics/motion/impulses.hpp"

namespace mechanics::inline motions {
namespace {

/// f'(v+) and what an impulse changes in it are rounded about so many times, relative to what f'(v+) is the
/// sum of; less is 0: a contact that the impact closed for good, or that did not push.
constexpr double roundings_of_impact = 1 << 10;

/// Rows and rates are rounded about so many times.
constexpr double roundings_of_rows = 64;

/// P that differ by less than this part are one, where it is asked whether they are unique.
constexpr double alike = 1e-9;

/// The least change of the velocity with u_a·change >= s_a.
convex::NearestPointProblem least_change(const convex::Metric& A, const std::vector<ImpactContact>& contacts,
                                         const Vector& s) {
  convex::RowMatrix U(s.size(), A.dimension());
  std::vector<Index> two_sided;
  for (Index a = 0; a < s.size(); ++a) {
    const ImpactContact& contact = contacts[static_cast<std::size_t>(a)];
    U.row(a) = contact.u.transpose();
    if (contact.two_sided) two_sided.push_back(a);
  }
  convex::NearestPointProblem problem{A, Vector::Zero(A.dimension()), convex::ConstraintRows(U), s,
                                      two_sided};
  problem.radii = convex::rounding_radii(problem, roundings_of_rows);
  return problem;
}

/// That of Moreau's law.
convex::NearestPointProblem moreau_problem(const convex::Metric& A,
                                           const std::vector<ImpactContact>& contacts) {
  Vector s(static_cast<Index>(contacts.size()));
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    const ImpactContact& contact = contacts[a];
    const double e = contact.two_sided || contact.rate > 0 ? 0 : contact.restitution;
    s[static_cast<Index>(a)] = -(1 + e) * contact.rate;
  }
  return least_change(A, contacts, s);
}

ImpactOutcome excluded(const convex::Solution& solution) {
  ImpactOutcome outcome;
  for (Index a = 0; a < solution.farkas.size(); ++a) {
    if (solution.farkas[a] == 0) continue;
    outcome.excluding.push_back(a);
    outcome.weights.push_back(solution.farkas[a]);
  }
  return outcome;
}

/// f'(v+) and P from a change and its P, 0 where rounding hides what they are. f'_a(v+) is the sum of
/// f'_a(v-) and of u_ai (A⁻¹u_b)_i P_b over the contacts b: contacts that do not move each other, however
/// fast, leave each other's digits alone.
ImpactOutcome rounded_outcome(const convex::Metric& A, const std::vector<ImpactContact>& contacts,
                              Vector change, Vector impulse) {
  Vector moved = Vector::Zero(change.size());
  Vector by_own(impulse.size());  // what the contact's own impulse changes in its rate
  for (std::size_t b = 0; b < contacts.size(); ++b) {
    const auto at = static_cast<Index>(b);
    by_own[at] = 0;
    if (impulse[at] == 0) continue;
    const Vector along = A.solve(contacts[b].u);
    moved += std::abs(impulse[at]) * along.cwiseAbs();
    by_own[at] = impulse[at] * contacts[b].u.dot(along);
  }
  Vector rates(impulse.size());
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    const auto at = static_cast<Index>(a);
    const ImpactContact& contact = contacts[a];
    const double by_rounding = roundings_of_impact * convex::unit_roundoff *
                               (std::abs(contact.rate) + contact.u.cwiseAbs().dot(moved));
    const double after = contact.rate + contact.u.dot(change);
    rates[at] = std::abs(after) <= by_rounding ? 0 : after;
    if (!contact.two_sided && by_own[at] <= by_rounding) impulse[at] = 0;
  }
  return {std::move(change), std::move(impulse), std::move(rates)};
}

/// One contact alone: v+ - v- along A⁻¹u. Nothing where |u|² leaves the range of doubles.
std::optional<ImpactOutcome> single_impact(const convex::Metric& A, const ImpactContact& contact) {
  const double s = -(1 + (contact.rate > 0 ? 0 : contact.restitution)) * contact.rate;
  Vector along = A.solve(contact.u);
  const double square = contact.u.dot(along), impulse = s / square;
  if (!std::isnormal(square) || !std::isfinite(impulse)) return std::nullopt;
  if (!(impulse > 0)) return ImpactOutcome{Vector::Zero(along.size()), Vector{{0}}, Vector{{contact.rate}}};
  along *= impulse;
  return ImpactOutcome{std::move(along), Vector{{impulse}}, Vector{{contact.rate + s}}};
}

/// Whether e_a P_a is determined up to what two-sided rows take up. Impulses with Σ mu_a u_a = 0 may be added
/// to P; with one e on its one-sided rows, what they expand by is in the span of the two-sided ones.
bool is_expansion_determined(const std::vector<ImpactContact>& contacts, const convex::Multipliers& all) {
  if (all.unique) return true;
  if (!all.null_space) return false;
  for (const convex::NullVector& mu : *all.null_space) {
    const auto part = [&](const std::pair<Index, double>& entry) {
      return std::abs(entry.second) * contacts[static_cast<std::size_t>(entry.first)].u.norm();
    };
    double largest = 0, e = -1;
    for (const auto& entry : mu) largest = std::max(largest, part(entry));
    for (const auto& entry : mu) {
      const ImpactContact& contact = contacts[static_cast<std::size_t>(entry.first)];
      if (contact.two_sided || part(entry) <= alike * largest) continue;
      if (e >= 0 && contact.restitution != e) return false;
      e = contact.restitution;
    }
  }
  return true;
}

bool have_one_restitution(const std::vector<ImpactContact>& contacts) {
  double e = -1;
  for (const ImpactContact& contact : contacts) {
    if (contact.two_sided) continue;
    if (e >= 0 && contact.restitution != e) return false;
    e = contact.restitution;
  }
  return true;
}

}  // namespace

const char* name(ImpactLaw law) {
  switch (law) {
    case ImpactLaw::moreau:
      return "moreau";
    case ImpactLaw::poisson:
      return "poisson";
    case ImpactLaw::sequential:
      return "sequential";
  }
  return "";
}

std::optional<ImpactLaw> impact_law_named(std::string_view wanted) {
  for (const ImpactLaw law : impact_laws)
    if (wanted == name(law)) return law;
  return std::nullopt;
}

ImpactOutcome impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts, ImpactLaw law) {
  for (const ImpactContact& contact : contacts) {
    if (contact.u.size() != A.dimension())
      throw convex::InvalidInput("u of a contact: " + convex::counted(contact.u.size(), "entry", "entries") +
                                 "; give " + std::to_string(A.dimension()) + ", one per coordinate");
    if (!contact.u.allFinite() || !std::isfinite(contact.rate))
      throw convex::InvalidInput("u or rate of a contact: not finite; give finite numbers");
    if (!(contact.restitution >= 0 && contact.restitution <= 1))
      throw convex::InvalidInput(
          "restitution of a contact: not from 0 to 1; an impact takes energy, or keeps it");
  }
  switch (law) {
    case ImpactLaw::moreau:
      return moreau_impact(A, contacts);
    case ImpactLaw::poisson:
      return poisson_impact(A, contacts);
    case ImpactLaw::sequential:
      return sequential_impact(A, contacts);
  }
  return {};
}

ImpactOutcome moreau_impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts) {
  if (contacts.size() == 1 && !contacts.front().two_sided)
    if (std::optional<ImpactOutcome> outcome = single_impact(A, contacts.front())) return *std::move(outcome);
  convex::Solution solution = convex::automatic(moreau_problem(A, contacts));
  if (solution.status == convex::Status::infeasible) return excluded(solution);
  return rounded_outcome(A, contacts, std::move(solution.q), std::move(solution.lambda));
}

Impulses impulses_of(const convex::Metric& A, const std::vector<ImpactContact>& contacts,
                     const ImpactOutcome& outcome) {
  std::vector<ImpactContact> pushing;
  std::vector<Index> which;
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    const auto at = static_cast<Index>(a);
    if (!contacts[a].two_sided && !(contacts[a].rate < 0) && !(outcome.impulse[at] > 0)) continue;
    pushing.push_back(contacts[a]);
    which.push_back(at);
  }
  // v+ - v- = A⁻¹ Σ P_a u_a, P_a >= 0, is the least change that does as much to these contacts.
  Vector s(static_cast<Index>(which.size()));
  for (std::size_t k = 0; k < pushing.size(); ++k)
    s[static_cast<Index>(k)] = pushing[k].u.dot(outcome.change);
  const convex::NearestPointProblem problem = least_change(A, pushing, s);
  const convex::Solution solution = convex::automatic(problem);
  Impulses found{true, outcome.impulse};
  if (solution.status == convex::Status::infeasible) return found;
  const convex::Multipliers all = convex::multipliers(problem, solution, alike, false);
  found.unique = all.unique;
  for (std::size_t k = 0; k < which.size() && !all.unique; ++k)
    found.least_norm[which[k]] = all.least_norm[static_cast<Index>(k)];
  return found;
}

Impulses moreau_impulses(const convex::Metric& A, const std::vector<ImpactContact>& contacts) {
  const convex::NearestPointProblem problem = moreau_problem(A, contacts);
  const convex::Solution solution = convex::automatic(problem);
  if (solution.status == convex::Status::infeasible) return {};
  convex::Multipliers all = convex::multipliers(problem, solution, alike, false);
  return {all.unique, std::move(all.least_norm)};
}

ImpactOutcome poisson_impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts) {
  Vector s(static_cast<Index>(contacts.size()));
  for (std::size_t a = 0; a < contacts.size(); ++a) s[static_cast<Index>(a)] = -contacts[a].rate;
  const convex::NearestPointProblem closing = least_change(A, contacts, s);
  const convex::Solution compression = convex::automatic(closing);
  if (compression.status == convex::Status::infeasible) return excluded(compression);
  if (!have_one_restitution(contacts) &&
      !is_expansion_determined(contacts, convex::multipliers(closing, compression, alike, false))) {
    ImpactOutcome outcome;
    outcome.undetermined =
        "Poisson's law does not determine the impact: the impulses of compression are not unique, and the "
        "restitutions differ";
    return outcome;
  }
  // What expands at least, e P_c, and the least change from there.
  Vector given = Vector::Zero(s.size()), least = Vector::Zero(A.dimension());
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    const auto at = static_cast<Index>(a);
    if (contacts[a].two_sided) continue;
    given[at] = contacts[a].restitution * compression.lambda[at];
    least += given[at] * contacts[a].u;
  }
  const Vector before = compression.q + A.solve(least);
  Vector terms(s.size());  // what s is the sum of: it may all but cancel
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    const auto at = static_cast<Index>(a);
    s[at] = -contacts[a].rate - contacts[a].u.dot(before);
    terms[at] = std::abs(contacts[a].rate) + contacts[a].u.cwiseAbs().dot(before.cwiseAbs());
  }
  convex::NearestPointProblem opening = least_change(A, contacts, s);
  opening.radii->s = roundings_of_rows * convex::unit_roundoff * terms;
  const convex::Solution expansion = convex::automatic(opening);
  if (expansion.status == convex::Status::infeasible) return excluded(expansion);
  return rounded_outcome(A, contacts, before + expansion.q, compression.lambda + given + expansion.lambda);
}

}  // namespace mechanics::inline motions
