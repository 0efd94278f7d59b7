#include <cmath>

#include "mechanics/motion/held_rows.hpp"
#include "mechanics/motion/impact.hpp"

namespace mechanics::inline motions {
namespace {

constexpr long most_strokes = 100'000;

/// A contact closes no longer when its rate is what so many roundings leave of all that it was the sum of.
constexpr double roundings_of_stroke = 64;
/// What has not come to rest after all strokes, but to this part, goes to its limit.
constexpr double nearly_at_rest = 1e-6;

/// Two contacts as bad as each other.
constexpr double tie = 1e-12;

/// A stroke of one contact, with the two-sided ones held: what it does to every rate, for f' -> f' + 1 of its
/// own.
struct Stroke {
  Vector change, rates;
  double impulse = 0;
  Vector impulse_two_sided;
  bool is_possible = false;
};

Stroke stroke(const convex::Metric& A, const std::vector<ImpactContact>& contacts, std::size_t striking) {
  std::vector<Vector> rows;
  for (const ImpactContact& contact : contacts)
    if (contact.two_sided) rows.push_back(contact.u);
  const auto held = static_cast<Index>(rows.size());
  rows.push_back(contacts[striking].u);
  const HeldRows together(A, rows);
  Stroke found;
  Vector s = Vector::Zero(held + 1);
  s[held] = 1;
  const HeldRows::Answer answer = together.solve(Vector::Zero(A.dimension()), s);
  found.is_possible = !together.independent().empty() && together.independent().back() == held;
  found.change = answer.x;
  found.impulse = answer.lambda[held];
  found.impulse_two_sided = answer.lambda.head(held);
  found.rates.resize(static_cast<Index>(contacts.size()));
  for (std::size_t a = 0; a < contacts.size(); ++a)
    found.rates[static_cast<Index>(a)] = contacts[a].two_sided ? 0 : contacts[a].u.dot(answer.x);
  found.rates[static_cast<Index>(striking)] = 1;
  return found;
}

}  // namespace

ImpactOutcome sequential_impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts) {
  const std::size_t m = contacts.size();
  ImpactOutcome outcome{Vector::Zero(A.dimension()), Vector::Zero(static_cast<Index>(m)),
                        Vector(static_cast<Index>(m))};
  std::vector<Stroke> strokes(m);
  Vector length(static_cast<Index>(m));
  Vector all(static_cast<Index>(m));  // what the rate is the sum of
  double largest = 0;
  for (std::size_t a = 0; a < m; ++a) {
    const auto at = static_cast<Index>(a);
    length[at] = A.dual_norm(contacts[a].u);
    outcome.rate[at] = contacts[a].two_sided ? 0 : contacts[a].rate;
    all[at] = std::abs(outcome.rate[at]);
    if (contacts[a].two_sided) continue;
    strokes[a] = stroke(A, contacts, a);
    largest = std::max(largest, std::abs(outcome.rate[at]) / length[at]);
  }
  const auto by_rounding = [&](Index a) { return roundings_of_stroke * convex::unit_roundoff * all[a]; };
  long count = 0;
  double worst = 0;
  for (; count < most_strokes; ++count) {
    std::size_t striking = m;
    worst = 0;
    for (std::size_t a = 0; a < m; ++a)
      if (const double speed = -outcome.rate[static_cast<Index>(a)] / length[static_cast<Index>(a)];
          !contacts[a].two_sided && speed > worst * (1 + tie) &&
          -outcome.rate[static_cast<Index>(a)] > by_rounding(static_cast<Index>(a))) {
        worst = speed;
        striking = a;
      }
    if (striking == m) break;
    for (std::size_t b = striking + 1; b < m && outcome.remark.empty(); ++b)
      if (!contacts[b].two_sided &&
          -outcome.rate[static_cast<Index>(b)] >= worst * (1 - tie) * length[static_cast<Index>(b)] &&
          std::abs(strokes[striking].rates[static_cast<Index>(b)]) >
              tie * length[static_cast<Index>(b)] / length[static_cast<Index>(striking)])
        outcome.remark =
            "contacts that close alike strike one after the other, and the outcome depends on which is "
            "first: the "
            "first of the file is taken";
    const Stroke& by = strokes[striking];
    if (!by.is_possible) {
      for (std::size_t a = 0; a < m; ++a)
        if (contacts[a].two_sided || a == striking) outcome.excluding.push_back(static_cast<Index>(a));
      return outcome;
    }
    const auto at = static_cast<Index>(striking);
    const double change = -(1 + contacts[striking].restitution) * outcome.rate[at];
    outcome.change += change * by.change;
    outcome.impulse[at] += change * by.impulse;
    Index held = 0;
    for (std::size_t a = 0; a < m; ++a)
      if (contacts[a].two_sided)
        outcome.impulse[static_cast<Index>(a)] += change * by.impulse_two_sided[held++];
    const double after = -contacts[striking].restitution * outcome.rate[at];
    outcome.rate += change * by.rates;
    all += (change * by.rates).cwiseAbs();
    outcome.rate[at] = after;
  }
  if (count == most_strokes && worst > nearly_at_rest * largest) {
    outcome.undetermined = "the sequence of impacts, one contact at a time, has no end within 100000";
    return outcome;
  }
  for (Index a = 0; a < outcome.rate.size(); ++a)
    if (outcome.rate[a] <= by_rounding(a)) outcome.rate[a] = 0;
  return outcome;
}

}  // namespace mechanics::inline motions
