#include <algorithm>
#include <cmath>

#include "mechanics/motion/held_rows.hpp"
#include "mechanics/motion/impact.hpp"

namespace mechanics::inline motions {
namespace {

constexpr long most_strokes = 100'000;

/// A contact closes no longer when its rate is what so many roundings leave of all that it was the sum of.
/// Two contacts close alike when their speeds differ by no more than that, and one does not change the rate
/// of another by less than so many roundings of what the change is the sum of.
constexpr double roundings_of_stroke = 64;
/// What has not come to rest after all strokes, but to this part, goes to its limit.
constexpr double nearly_at_rest = 1e-6;

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
  // x is the sum of A⁻¹u_b lambda_b, which may all but cancel along rows that the two-sided ones hold.
  Vector moved = Vector::Zero(A.dimension());
  for (Index b = 0; b <= held; ++b)
    if (answer.lambda[b] != 0)
      moved += std::abs(answer.lambda[b]) * A.solve(rows[static_cast<std::size_t>(b)]).cwiseAbs();
  found.rates = Vector::Zero(static_cast<Index>(contacts.size()));
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    const double rate = contacts[a].u.dot(answer.x);
    const double by_rounding =
        roundings_of_stroke * convex::unit_roundoff * contacts[a].u.cwiseAbs().dot(moved);
    if (!contacts[a].two_sided && std::abs(rate) > by_rounding) found.rates[static_cast<Index>(a)] = rate;
  }
  found.rates[static_cast<Index>(striking)] = 1;
  return found;
}

/// A contact that closes at this rate where the two-sided ones hold its motion.
ImpactOutcome excluded_by_two_sided(const convex::Metric& A, const std::vector<ImpactContact>& contacts,
                                    std::size_t striking, const Vector& rates) {
  std::vector<ImpactContact> together;
  std::vector<Index> which;
  for (std::size_t a = 0; a < contacts.size(); ++a) {
    if (!contacts[a].two_sided && a != striking) continue;
    together.push_back(contacts[a]);
    together.back().rate = rates[static_cast<Index>(a)];
    which.push_back(static_cast<Index>(a));
  }
  ImpactOutcome excluded = moreau_impact(A, together);
  if (excluded.excluding.empty()) return {{}, {}, {}, which, std::vector<double>(which.size(), 0)};
  for (Index& k : excluded.excluding) k = which[static_cast<std::size_t>(k)];
  return excluded;
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
    all[at] = std::max(std::abs(outcome.rate[at]), contacts[a].rate_scale);
    if (contacts[a].two_sided) continue;
    strokes[a] = stroke(A, contacts, a);
    largest = std::max(largest, std::abs(outcome.rate[at]) / length[at]);
  }
  const auto by_rounding = [&](Index a) { return roundings_of_stroke * convex::unit_roundoff * all[a]; };
  // Of what closes by more than rounding: the speed f'/||u||, and what rounding leaves open of it.
  const auto closes = [&](std::size_t a) {
    const auto at = static_cast<Index>(a);
    return !contacts[a].two_sided && -outcome.rate[at] > by_rounding(at);
  };
  const auto speed = [&](std::size_t a) {
    return -outcome.rate[static_cast<Index>(a)] / length[static_cast<Index>(a)];
  };
  const auto are_alike = [&](std::size_t a, std::size_t b) {
    const auto i = static_cast<Index>(a), j = static_cast<Index>(b);
    return std::abs(speed(a) - speed(b)) <= by_rounding(i) / length[i] + by_rounding(j) / length[j];
  };
  const auto changes = [&](std::size_t a, std::size_t b) {
    return strokes[a].rates[static_cast<Index>(b)] != 0;
  };
  long count = 0;
  double worst = 0;
  for (; count < most_strokes; ++count) {
    std::size_t striking = m;
    for (std::size_t a = 0; a < m; ++a)
      if (closes(a) && (striking == m || speed(a) > speed(striking))) striking = a;
    if (striking == m) break;
    worst = speed(striking);
    const std::size_t fastest = striking;
    for (std::size_t a = 0; a < m; ++a) {
      if (a == fastest || !closes(a) || !are_alike(a, fastest)) continue;
      striking = std::min(striking, a);
      if (outcome.remark.empty() && (changes(fastest, a) || changes(a, fastest)))
        outcome.remark =
            "contacts that close alike strike one after the other, and the outcome depends on which is "
            "first: the first of the file is taken";
    }
    const Stroke& by = strokes[striking];
    if (!by.is_possible) return excluded_by_two_sided(A, contacts, striking, outcome.rate);
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
    ImpactOutcome without_end;
    without_end.undetermined = "the sequence of impacts, one contact at a time, has no end within 100000";
    return without_end;
  }
  for (Index a = 0; a < outcome.rate.size(); ++a)
    if (outcome.rate[a] <= by_rounding(a)) outcome.rate[a] = 0;
  return outcome;
}

}  // namespace mechanics::inline motions
