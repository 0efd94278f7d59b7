#include <algorithm>
#include <cmath>

#include "convex/nearest_point/automatic.hpp"
#include "mechanics/motion/expansion.hpp"

/// Who persists, and which coefficients are not 0: decided by what rounding can have made of them.
namespace mechanics::inline motions {

using expression::Slot;

namespace {

/// A state on the way is off by so many roundings of its numbers.
constexpr double roundings_of_state = 1 << 10;

/// A slack or a multiplier up to so many times what rounding can make of its terms is said to be in doubt:
/// the count of roundings is an estimate.
constexpr double factor_in_doubt = 100;

/// Where a derivative has no bound its magnitude has none, and nothing is known of what rounding makes of it.
double if_finite(double magnitude) { return std::isfinite(magnitude) ? magnitude : 0; }

bool is_in_doubt(double number, double by_rounding) {
  return number > by_rounding && number < factor_in_doubt * by_rounding;
}

/// Up to so many coordinates A⁻¹ is found entry by entry.
constexpr Index inverted_coordinates = 300;

/// Coefficients are rounded about so many times, where rows that depend on each other are compared.
constexpr double roundings_of_coefficients = 1 << 10;

[[noreturn]] void refuse_contradiction() {
  throw convex::InvalidInput(
      "whether contacts contradict each other hangs on their rounding; leave out those that others imply");
}

}  // namespace

/// Coefficient k of a coordinate, while order k of the series is looked for and after it.
double Expansion::next_coefficient(Slot coordinate, int k) const {
  const double known = series_[coordinate][index(k)];
  return known != 0 ? known : series_.at_order(coordinate);
}

Expansion::Magnitudes Expansion::magnitudes(const std::vector<Index>& constraints, int k) {
  const expression::Program& program = equations_.program;
  const auto n = program.coordinates();
  if (k == 0) {
    magnitude_.begin();
    if (coordinates() <= inverted_coordinates) {
      inverse_.resize(coordinates(), coordinates());
      for (Index i = 0; i < coordinates(); ++i)
        inverse_.col(i) = inertia().solve(Vector::Unit(coordinates(), i)).cwiseAbs();
    } else {
      unit_norms_ = inertia().diagonal().cwiseSqrt().cwiseInverse();
    }
  } else {
    for (std::size_t i = 0; i < n; ++i)
      magnitude_.value(program.velocity(i), k) = (k + 1) * next_coefficient(program.coordinate(i), k + 1);
    for (const std::size_t group : {std::size_t{0}, std::size_t{1}}) magnitude_.find(group, k);
  }
  Vector S = Vector::Zero(coordinates());
  for (const auto& [i, slot] : equations_.force) S[i] += magnitude_.at(slot, k);
  for (const Index a : pushing_)
    for (const auto& [i, slot] : equations_.row[index(a)])
      for (int j = 0; j < k; ++j)
        S[i] += std::abs(multiplier(a)[static_cast<std::size_t>(j)]) * magnitude_.at(slot, k - j);
  for (std::size_t i = 0; i < n; ++i)
    magnitude_.at(program.coordinate(i), k + 1) = magnitude_.at(program.velocity(i), k) / (k + 1);
  for (std::size_t i = 0; i < n; ++i) {
    magnitude_.value(program.coordinate(i), k + 1) =
        k == 0 ? series_[program.velocity(i)][0] : next_coefficient(program.coordinate(i), k + 1);
    magnitude_.at(program.velocity(i), k + 1) = magnitude_.value(program.velocity(i), k + 1) = 0;  // not yet
  }
  magnitude_.at(program.time(), k + 1) = magnitude_.value(program.time(), k + 1) = k == 0 ? 1 : 0;
  magnitude_.find(0, k + 1);
  for (Index i = 0; i < coordinates(); ++i)
    S[i] = S[i] / (k + 1) + magnitude_.at(equations_.momentum[index(i)], k + 1);
  for (const Index a : constraints.empty() ? pushing_ : constraints)
    for (const auto& [i, slot] : equations_.row[index(a)])
      S[i] += std::abs(multiplier(a)[static_cast<std::size_t>(k)]) / (k + 1) * magnitude_.at(slot, 0);
  Magnitudes of{Vector(static_cast<Index>(constraints.size())), {}};
  if (coordinates() <= inverted_coordinates)
    of.velocity = inverse_ * S;
  else  // |A⁻¹_ij| <= ||e_i|| ||e_j||
    of.velocity = unit_norms_.dot(S) * unit_norms_;
  for (std::size_t a = 0; a < constraints.size(); ++a)
    of.rates[static_cast<Index>(a)] = magnitude_.at(equations_.rate[index(constraints[a])], k + 1);
  for (std::size_t i = 0; i < n; ++i)
    magnitude_.at(program.velocity(i), k + 1) = of.velocity[static_cast<Index>(i)];
  of.velocity = of.velocity.unaryExpr(&if_finite);
  of.rates = of.rates.unaryExpr(&if_finite);
  return of;
}

void Expansion::note_reach(const State& at) {
  fastest_.resize(steps_.variables);
  for (Index i = 0; i < at.q.size(); ++i) {
    magnitude_.reach(equations_.program.coordinate(index(i)), std::abs(at.q[i]));
    double& fastest = fastest_[equations_.program.velocity(index(i))];
    fastest = std::max(fastest, std::abs(at.v[i]));
  }
}

bool Expansion::find_bases_at_zero() {
  magnitude_.begin(fastest_);
  magnitude_is_begun_ = false;
  std::vector<Slot>& found = series_.bases_at_zero();
  const std::size_t before = found.size();
  for (const TaylorStep& step : steps_.steps) {
    if (!takes_base(step) || std::find(found.begin(), found.end(), step.a) != found.end()) continue;
    const double base = series_[step.a][0];
    if (base != 0 && std::abs(base) <= rounding(0) * if_finite(magnitude_.at(step.a, 0)))
      found.push_back(step.a);
  }
  if (found.size() == before) return false;
  begin();
  return true;
}

bool Expansion::take_bases_for_zero() {
  const std::vector<Slot> before = series_.bases_at_zero();
  if (!find_bases_at_zero()) return false;
  const bool may_be = is_finite();  // x / |x| is not
  if (!may_be) {
    series_.bases_at_zero() = before;
    take(state_);
    begin();
  }
  find_inertia();
  return may_be;
}

std::vector<std::pair<Index, double>> Expansion::arguments_left_by_rounding() {
  std::vector<std::pair<Index, double>> found;
  if (series_.bases_at_zero().empty()) return found;
  magnitude_.begin(fastest_);
  magnitude_is_begun_ = false;
  for (std::size_t k = 0; k < switches(); ++k) {
    const Slot argument = steps_.switches[k].argument;
    const double left = rounding(0) * if_finite(magnitude_.at(argument, 0));
    if (branch(k) != 0 && std::abs(series_[argument][0]) <= left)
      found.emplace_back(static_cast<Index>(k), left);
  }
  return found;
}

double Expansion::rounding(int k) const {
  return (roundings_of_state + static_cast<double>(series_.operations() * static_cast<std::size_t>(k + 1))) *
         convex::unit_roundoff;
}

double Expansion::magnitude_of(expression::Slot series) {
  if (!magnitude_is_begun_) magnitude_.begin();
  magnitude_is_begun_ = true;
  return if_finite(magnitude_.at(series, 0));
}

bool Expansion::has_lost_gradient(Index a) {
  const auto& u = equations_.row[index(a)];
  return !u.empty() && std::all_of(u.begin(), u.end(), [&](const auto& entry) {
    constexpr double half_the_digits = 0x1p-26;
    return std::abs(series_[entry.second][0]) <= half_the_digits * magnitude_of(entry.second);
  });
}

double Expansion::magnitude_of_rate(Index a) { return magnitude_of(equations_.rate[index(a)]); }

double Expansion::magnitude_of_constraint(Index a) { return magnitude_of(equations_.constraint[index(a)]); }

double Expansion::rounding_of_rate(Index a) { return rounding(0) * magnitude_of_rate(a); }

Vector Expansion::rounding_of_multipliers(const std::vector<Index>& held) {
  const Magnitudes of = magnitudes(held, 0);
  Vector by_rounding(of.rates.size());
  for (Index k = 0; k < by_rounding.size(); ++k) {
    const Vector u = row(held[index(k)]);
    by_rounding[k] = rounding(0) * (of.rates[k] + of.along(u)) / u.dot(inertia().solve(u));
  }
  return by_rounding;
}

std::vector<std::vector<double>> Expansion::rounding_of_switches(const std::vector<Index>& which,
                                                                 int orders) {
  std::vector<std::vector<double>> found(which.size());
  for (int j = 0; j < orders && !which.empty(); ++j) {
    magnitudes({}, j);
    for (std::size_t i = 0; i < which.size(); ++i)
      found[i].push_back(rounding(j) *
                         if_finite(magnitude_.at(steps_.switches[index(which[i])].argument, j)));
  }
  return found;
}

double Expansion::rounding_of_argument(std::size_t k) {
  return rounding(0) * magnitude_of(steps_.switches[k].argument);
}

bool Expansion::has_open_angle() {
  const auto is_zero = [&](Slot series) {
    return std::abs(series_[series][0]) <= rounding(0) * magnitude_of(series);
  };
  return std::any_of(choosing_angles_.begin(), choosing_angles_.end(),
                     [&](const auto& angle) { return is_zero(angle.first) && is_zero(angle.second); });
}

/// Those of order k, with the lower ones if they were not needed so far.
Expansion::Magnitudes Expansion::magnitudes_of_order(const std::vector<Index>& constraints, int k) {
  for (; magnitudes_found_ < k; ++magnitudes_found_) magnitudes({}, magnitudes_found_);
  magnitudes_found_ = k + 1;
  return magnitudes(constraints, k);
}

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
  const auto by_rounding = [&](Index a) {
    const Vector u = row(open[index(a)]);
    return std::max(rounding(k) * (std::abs(s[a]) + of.rates[a] + of.along(u)),
                    k == 0 ? left_of_push(open[index(a)], u) : 0);
  };
  for (Index a = 0; a < s.size(); ++a)
    if (slack[a] < -by_rounding(a)) return false;
  std::vector<Index> undecided;
  for (Index a = 0; a < s.size(); ++a) {
    const Index contact = open[index(a)];
    if (is_in_doubt(slack[a], by_rounding(a))) in_doubt_.push_back(contact);
    if (slack[a] > by_rounding(a))
      answer.open.push_back({contact, k + 2});
    else
      undecided.push_back(contact);
  }
  open = std::move(undecided);
  return true;
}

Vector Expansion::choose(std::vector<Index>& persist, std::vector<Index>& open, ContactAnswer& answer,
                         int k) {
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
  std::vector<Index> undecided;
  for (std::size_t a = persist.size(); a < rows.size(); ++a) {
    const auto at = static_cast<Index>(a);
    const Vector u = U.row(at).transpose();
    // What the contact's push changes in d²f/dt², and what rounding may have made of that.
    const double push = lambda[at] * u.dot(A.solve(u));
    const double by_rounding = std::max(part * (std::abs(s[at]) + of.rates[at] + of.along(u)),
                                        k == 0 ? left_of_push(rows[a], u) : 0);
    if (is_in_doubt(slack[at], by_rounding) || is_in_doubt(push, by_rounding)) in_doubt_.push_back(rows[a]);
    if (slack[at] > by_rounding) {
      answer.open.push_back({rows[a], k + 2});
    } else if (push > by_rounding) {
      persist.push_back(rows[a]);
      pushing_.push_back(rows[a]);
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
