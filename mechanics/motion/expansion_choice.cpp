#include <algorithm>
#include <cmath>

#include "convex/nearest_point/automatic.hpp"
#include "mechanics/motion/expansion.hpp"

/// Who persists, and which coefficients are not 0: decided by what rounding can have made of them.
namespace mechanics::inline motions {

using expression::Slot;

namespace {

/// A slack or a multiplier up to so many times what rounding can make of its terms is said to be in doubt:
/// the count of roundings is an estimate.
constexpr double factor_in_doubt = 100;

bool is_in_doubt(double number, double by_rounding) {
  return number > by_rounding && number < factor_in_doubt * by_rounding;
}

/// Coefficients are rounded about so many times, where rows that depend on each other are compared.
constexpr double roundings_of_coefficients = 1 << 10;

[[noreturn]] void refuse_contradiction() {
  throw convex::InvalidInput(
      "whether contacts contradict each other hangs on their rounding; leave out those that others imply");
}

}  // namespace

/// What may be left of a contact's push where its multiplier has come to 0: of other multipliers that come to
/// 0 with it, the terms are gone by which their rounding would be known.
double Expansion::left_of_push(Index a, const Vector& u) const {
  for (const ContactQuestion::Unloaded& one : unloaded_)
    if (one.constraint == a) return one.left * u.dot(inertia().solve(u));
  return 0;
}

bool Expansion::leaves_open(const Vector& v, const std::vector<Index>& persist,
                            const std::optional<HeldRows>& rows, std::vector<Index>& open,
                            ContactAnswer& answer, int k) {
  if (rows && rows->independent().size() < persist.size()) return false;  // they may exclude each other
  const Vector s = missing_rate(open);
  Vector slack(s.size());
  for (Index a = 0; a < s.size(); ++a) slack[a] = row(open[index(a)]).dot(v) - s[a];
  if (slack.isZero(0)) return true;
  if (k == 0 && slack.minCoeff() < 0) return false;  // as a rule they push
  std::vector<Index> all = open;
  all.insert(all.end(), persist.begin(), persist.end());
  const Magnitudes of = magnitudes_of_order(all, k);
  const Vector held = missing_rate(persist);
  Vector by_rounding(s.size());
  for (Index a = 0; a < s.size(); ++a) {
    const Index contact = open[index(a)];
    const Vector u = row(contact);
    by_rounding[a] = std::max(rounding(k) * (std::abs(s[a]) + of.rates[a] + of.along(u)),
                              k == 0 ? left_of_push(contact, u) : 0);
    for (Index b = 0; b < held.size() && std::abs(slack[a]) <= by_rounding[a]; ++b) {
      const auto beside = slack_beside({contact, s[a], of.rates[a]},
                                       {persist[index(b)], held[b], of.rates[s.size() + b]}, v, of, k);
      if (!beside || beside->left >= by_rounding[a]) continue;
      slack[a] = beside->slack;
      by_rounding[a] = beside->left;
      if (!(slack[a] < -by_rounding[a])) continue;
      contradict(contact, persist[index(b)], beside->times, answer);
      return false;
    }
    if (slack[a] < -by_rounding[a]) return false;
  }
  std::vector<Index> undecided;
  for (Index a = 0; a < s.size(); ++a) {
    const Index contact = open[index(a)];
    if (is_in_doubt(slack[a], by_rounding[a])) in_doubt_.push_back(contact);
    if (slack[a] > by_rounding[a])
      answer.open.push_back({contact, k + 2});
    else
      undecided.push_back(contact);
  }
  open = std::move(undecided);
  return true;
}

Vector Expansion::choose(std::vector<Index>& persist, std::vector<Index>& open, ContactAnswer& answer,
                         int k) {
  if (!answer.excluding.empty()) return Vector::Zero(coordinates());
  const auto limits =
      std::find_if(may_push_.begin(), may_push_.end(), [k](const MayPush& one) { return one.order == k; });
  const auto others = std::stable_partition(open.begin(), open.end(), [&](Index a) {
    return limits == may_push_.end() || is_among(limits->contacts, a);
  });
  std::vector<Index> rows = persist;
  rows.insert(rows.end(), open.begin(), open.end());
  const auto asked = static_cast<Index>(persist.size()) + (others - open.begin());
  convex::RowMatrix U(static_cast<Index>(rows.size()), coordinates());
  for (std::size_t a = 0; a < rows.size(); ++a) U.row(static_cast<Index>(a)) = row(rows[a]).transpose();
  const convex::Metric& A = inertia();
  const Vector s = missing_rate(rows);
  convex::NearestPointProblem problem{A, r_, convex::ConstraintRows(U.topRows(asked)), s.head(asked), {}};
  for (std::size_t a = 0; a < persist.size(); ++a) problem.two_sided.push_back(static_cast<Index>(a));
  problem.radii = convex::rounding_radii(problem, roundings_of_coefficients);
  const convex::Solution solution = convex::automatic(problem);
  if (solution.status == convex::Status::infeasible) {
    for (Index a = 0; a < asked; ++a)
      if (solution.farkas[a] != 0) {
        answer.excluding.push_back(rows[index(a)]);
        weights_.push_back(solution.farkas[a]);
      }
    return Vector::Zero(coordinates());
  }
  if (solution.lambda.size() == 0) refuse_contradiction();
  Vector lambda = Vector::Zero(s.size()), slack = U * solution.q - s;
  lambda.head(asked) = solution.lambda;
  slack.head(asked) = solution.slack;
  give_multipliers(k, rows, lambda * (k + 1));
  const Magnitudes of = magnitudes_of_order(rows, k);
  const double part = rounding(k);
  Vector push(s.size()), by_rounding(s.size());
  std::vector<Index> holding;  // of the rows
  for (std::size_t a = 0; a < rows.size(); ++a) {
    const auto at = static_cast<Index>(a);
    const Vector u = U.row(at).transpose();
    // What the contact's push changes in d²f/dt², and what rounding may have made of that.
    push[at] = lambda[at] * u.dot(A.solve(u));
    by_rounding[at] = std::max(part * (std::abs(s[at]) + of.rates[at] + of.along(u)),
                               k == 0 ? left_of_push(rows[a], u) : 0);
    const bool pushes = push[at] > by_rounding[at] && !(slack[at] > by_rounding[at]);
    if (a >= persist.size() && pushes) pushing_.push_back(rows[a]);
    if (a < persist.size() || pushes) holding.push_back(at);
  }
  std::vector<Index> undecided;
  const auto count = persist.size();
  for (std::size_t a = count; a < rows.size(); ++a) {
    const auto at = static_cast<Index>(a);
    const bool pushes = is_among(holding, at);
    if (is_in_doubt(slack[at], by_rounding[at]) || is_in_doubt(push[at], by_rounding[at]))
      in_doubt_.push_back(rows[a]);
    for (const Index b : holding) {
      if (pushes || std::abs(slack[at]) > by_rounding[at]) break;
      const auto beside = slack_beside({rows[a], s[at], of.rates[at]}, {rows[index(b)], s[b], of.rates[b]},
                                       solution.q, of, k);
      if (!beside || beside->left >= by_rounding[at]) continue;
      slack[at] = beside->slack;
      by_rounding[at] = beside->left;
      if (!(slack[at] < -by_rounding[at])) continue;
      contradict(rows[a], rows[index(b)], beside->times, answer);
      return Vector::Zero(coordinates());
    }
    if (pushes) {
      persist.push_back(rows[a]);
    } else if (slack[at] > by_rounding[at]) {
      answer.open.push_back({rows[a], k + 2});
    } else {
      undecided.push_back(rows[a]);
      lambda_[index(rows[a] * (order_ - 1) + k)] = 0;
    }
  }
  open = std::move(undecided);
  return solution.q;
}

int Expansion::first_push(Index a) const {
  const std::span<const double> lambda = multiplier(a);
  return static_cast<int>(std::find_if(lambda.begin(), lambda.end(), [](double c) { return c != 0; }) -
                          lambda.begin());
}

/// Multipliers of gradients that depend on each other are not unique, and contacts that were found to push at
/// a lower order may contradict one that can take over from them, as the floor of {y >= 0, y >= x²} does once
/// x moves. Along the weights of the contradiction, Σ w_a u_a = 0, multipliers change no force and raise the
/// dual objective w·s of this order; they go so far until one comes to 0, of which the contact lets go
/// (Goldfarb and Idnani 1983). Where none does the contradiction is one of the contacts.
bool Expansion::exchange(const ContactQuestion& contacts, const ContactAnswer& answer) {
  const auto is_one_sided = [&](Index a) { return !is_among(contacts.held, a); };
  Index leaving = -1;
  int order = -1;
  double least = 0;
  for (std::size_t i = 0; i < answer.excluding.size(); ++i) {
    const Index a = answer.excluding[i];
    if (!(weights_[i] < 0) || !is_one_sided(a) || !is_among(pushing_, a)) continue;
    const int first = first_push(a);
    const double length = -multiplier(a)[index(first)] / weights_[i];
    if (first < order || (first == order && length >= least)) continue;
    leaving = a, order = first, least = length;
  }
  if (leaving < 0) return false;
  MayPush next{order, {}};
  for (const Index a : pushing_)
    if (is_one_sided(a) && a != leaving && first_push(a) == order) next.contacts.push_back(a);
  for (std::size_t i = 0; i < answer.excluding.size(); ++i) {
    const Index a = answer.excluding[i];
    const bool pushes = is_among(pushing_, a) && first_push(a) <= order;
    if (weights_[i] > 0 && is_one_sided(a) && !pushes) next.contacts.push_back(a);
  }
  std::sort(next.contacts.begin(), next.contacts.end());
  std::erase_if(may_push_, [&](const MayPush& one) { return one.order >= order; });
  may_push_.push_back(std::move(next));
  if (std::find(exchanged_.begin(), exchanged_.end(), may_push_) != exchanged_.end()) refuse_contradiction();
  exchanged_.push_back(may_push_);
  return true;
}

}  // namespace mechanics::inline motions
