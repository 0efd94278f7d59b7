#include <algorithm>
#include <cmath>

#include "mechanics/motion/expansion.hpp"

/// What rounding can have made of values and coefficients.
namespace mechanics::inline motions {

using expression::Slot;

namespace {

/// A state on the way is off by so many roundings of its numbers.
constexpr double roundings_of_state = 1 << 10;

/// Where a derivative has no bound its magnitude has none, and nothing is known of what rounding makes of it.
double if_finite(double magnitude) { return std::isfinite(magnitude) ? magnitude : 0; }

/// Up to so many coordinates A⁻¹ is found entry by entry.
constexpr Index inverted_coordinates = 300;

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
  return roundings_of_state * convex::unit_roundoff + rounding_of_operations(k);
}

double Expansion::rounding_of_operations(int k) const {
  return static_cast<double>(series_.operations() * static_cast<std::size_t>(k + 1)) * convex::unit_roundoff;
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

double Expansion::rounding_of_rate_so_far(Index a) {
  magnitude_.begin(fastest_);
  magnitude_is_begun_ = false;
  return rounding(0) * if_finite(magnitude_.at(equations_.rate[index(a)], 0));
}

Expansion::Roundings Expansion::roundings_so_far() {
  magnitude_.begin(fastest_);
  magnitude_is_begun_ = false;
  Roundings found{Vector(constraints()), Vector(constraints())};
  for (Index a = 0; a < constraints(); ++a) {
    found.f[a] = rounding(0) * if_finite(magnitude_.at(equations_.constraint[index(a)], 0));
    found.rate[a] = rounding(0) * if_finite(magnitude_.at(equations_.rate[index(a)], 0));
  }
  return found;
}

Vector Expansion::rounding_of_multipliers(const std::vector<Index>& held) {
  const Magnitudes of = magnitudes(held, 0);
  Vector by_rounding(of.rates.size());
  for (Index k = 0; k < by_rounding.size(); ++k) {
    const Vector u = row(held[index(k)]);
    by_rounding[k] = rounding(0) * (of.rates[k] + of.along(u)) / u.dot(inertia().solve(u));
  }
  return by_rounding;
}

std::vector<std::vector<double>> Expansion::rounding_of_series(const std::vector<Slot>& which, int orders) {
  std::vector<std::vector<double>> found(which.size());
  for (int j = 0; j < orders && !which.empty(); ++j) {
    magnitudes({}, j);
    for (std::size_t i = 0; i < which.size(); ++i)
      found[i].push_back(rounding(j) * if_finite(magnitude_.at(which[i], j)));
  }
  return found;
}

std::vector<std::vector<double>> Expansion::rounding_of_switches(const std::vector<Index>& which,
                                                                 int orders) {
  std::vector<Slot> series;
  for (const Index k : which) series.push_back(steps_.switches[index(k)].argument);
  return rounding_of_series(series, orders);
}

std::vector<std::vector<double>> Expansion::rounding_of_rates(const std::vector<Index>& which, int orders) {
  std::vector<Slot> series;
  for (const Index a : which) series.push_back(equations_.rate[index(a)]);
  return rounding_of_series(series, orders);
}

double Expansion::rounding_of_argument(std::size_t k) {
  return rounding(0) * magnitude_of(steps_.switches[k].argument);
}

double Expansion::part_as_given() const {
  return (convex::unit_roundoff + rounding_of_operations(0)) / rounding(0);
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

}  // namespace mechanics::inline motions
