#include "mechanics/assembly.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "convex/nearest_point/automatic.hpp"
#include "mechanics/expression/exclusion.hpp"
#include "mechanics/expression/lagrangian_model.hpp"
#include "mechanics/position_search.hpp"

namespace mechanics {
namespace {

constexpr int most_starts = 48, starts_compared = 12;
constexpr double roundings_of_velocity_rows = 64;

/// Starts around the guess, further and further away; the first is the guess itself.
class Starts {
 public:
  Starts(const State& guess, const std::vector<Index>& free) : guess_(guess), free_(free) {}

  Vector next() {
    Vector q = guess_.q;
    if (count_ > 0) {
      const double reach = 0.05 * std::pow(1.12, count_);
      for (const Index i : free_) q[i] += reach * std::max(1.0, std::abs(guess_.q[i])) * even_(random_);
    }
    ++count_;
    return q;
  }

 private:
  const State& guess_;
  const std::vector<Index>& free_;
  int count_ = 0;
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> even_{-1, 1};
};

/// Of two places the one that misses less; where both miss nothing, the one nearer to the end of its search;
/// of two ends the one nearer to the guess.
bool is_better(const PositionSearch& search, const TriedPosition& a, const TriedPosition& b) {
  if (!(a.missing <= not_found && b.missing <= not_found)) return a.missing < b.missing;
  if (!(a.step <= not_found && b.step <= not_found)) return a.step < b.step;
  return search.moved(a) < search.moved(b);
}

/// A place where all holds, locally the nearest one to the guess; else the one nearest to that. Where the
/// guess itself leads nowhere, the nearest of what the first starts around it lead to.
TriedPosition feasible(const PositionSearch& search, const State& guess, int starts) {
  std::optional<TriedPosition> best;
  Starts from(guess, search.free());
  for (int k = 0, last = starts; k < last; ++k) {
    try {
      const TriedPosition start = search.at(from.next());
      TriedPosition found = k == 0 ? search.nearest(start) : search.restored(start, most_restorations);
      if (k > 0 && found.missing <= not_found) found = search.nearest(found);
      if (!best || is_better(search, found, *best)) best = std::move(found);
      if (best->missing > rounding_part || best->step > not_found) continue;
      if (k == 0) return *best;
      last = std::min(last, std::max(k + 1, starts_compared));
    } catch (const convex::InvalidInput&) {
      if (k == 0 && starts == 1) throw;
    }
  }
  if (!best) {
    search.at(guess.q);  // says what is not finite
    throw convex::InvalidInput("the constraints are not finite anywhere near the state; start elsewhere");
  }
  return *best;
}

/// Those violated constraints of which none can be left out.
std::vector<Index> fighters(PositionSearch& search, const State& guess, const TriedPosition& best) {
  std::vector<Index> found;
  double worst = 0;
  for (Index a = 0; a < best.f.size(); ++a)
    worst = std::max(worst, std::abs(search.violation(best, a)) / best.scale[a]);
  for (Index a = 0; a < best.f.size(); ++a) {
    const bool is_violated = std::abs(search.violation(best, a)) / best.scale[a] > 1e-6 * worst;
    search.leave_out(a, !is_violated);
    if (is_violated) found.push_back(a);
  }
  constexpr std::size_t most_tried = 12;
  if (found.size() > most_tried) return found;
  for (std::size_t k = 0; k < found.size() && found.size() > 1;) {
    search.leave_out(found[k], true);
    if (feasible(search, guess, most_starts / 4).missing > not_found) {
      found.erase(found.begin() + static_cast<std::ptrdiff_t>(k));
    } else {
      search.leave_out(found[k], false);
      ++k;
    }
  }
  return found;
}

/// Is it proved that no position meets these constraints, with the coordinates held where they are?
bool is_proved(const LagrangianSystem& system, const PositionSearch& search, const State& guess,
               const std::vector<Index>& constraints) {
  const expression::LagrangianModel& model = system.model();
  std::vector<expression::Demand> demands;
  for (const Index a : constraints)
    demands.push_back({model.f[static_cast<std::size_t>(a)], search.is_equal(a)});
  std::vector<std::optional<double>> held;
  for (const double q : guess.q) held.emplace_back(q);
  for (const Index i : search.free()) held[static_cast<std::size_t>(i)].reset();
  return expression::excludes(model.tape, demands, held, guess.t);
}

/// The constraints of which no search meets all, proved to exclude each other where that is possible: those
/// that the search ends on, or else those of all constraints that a proof needs.
void find_fighters(const LagrangianSystem& system, PositionSearch& search, const State& guess,
                   const TriedPosition& best, Assembly& found) {
  found.fighting = fighters(search, guess, best);
  found.proved = is_proved(system, search, guess, found.fighting);
  constexpr Index most_proved = 24;
  if (found.proved || best.f.size() > most_proved) return;
  std::vector<Index> all;
  for (Index a = 0; a < best.f.size(); ++a) all.push_back(a);
  if (all.size() == found.fighting.size() || !is_proved(system, search, guess, all)) return;
  for (std::size_t k = 0; k < all.size();) {
    std::vector<Index> fewer = all;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
    if (is_proved(system, search, guess, fewer))
      all = fewer;
    else
      ++k;
  }
  found.fighting = all;
  found.proved = true;
}

/// The nearest velocity; returns the constraints whose rates exclude each other, if any.
std::vector<Index> set_velocity(const LagrangianSystem& system, const PositionSearch& search, State& state) {
  std::vector<Index> rows, two_sided;
  const ConstraintRates rates = system.constraint_rates(state);
  for (Index a = 0; a < rates.f.size(); ++a) {
    if (!search.is_equal(a) && rates.f[a] > not_found * rates.f_scale[a]) continue;
    if (search.is_equal(a)) two_sided.push_back(static_cast<Index>(rows.size()));
    rows.push_back(a);
  }
  if (rows.empty()) return {};
  const Matrix U = Matrix(system.contact_rows(state, rows).U)(Eigen::all, search.free());
  const auto n = static_cast<Index>(search.free().size());
  const Vector v0 = state.v(search.free());
  Vector change = Vector::Zero(n);
  for (int pass = 0; pass < 3; ++pass) {
    const ConstraintRates now = system.constraint_rates(state);
    // From v0 + change on: the nearest to v0 with u·(v - v_now) >= -df_now.
    Vector s(U.rows());
    for (Index k = 0; k < s.size(); ++k) {
      const double df = now.df[rows[static_cast<std::size_t>(k)]];
      s[k] = U.row(k).dot(change) - df;
    }
    convex::NearestPointProblem problem{convex::Metric::dense(search.A()), Vector::Zero(n),
                                        convex::ConstraintRows(convex::RowMatrix(U)), s, two_sided};
    problem.radii = convex::rounding_radii(problem, roundings_of_velocity_rows);
    const convex::Solution solution = convex::automatic(problem);
    if (solution.q.size() == 0) {
      std::vector<Index> excluding;
      for (Index k = 0; k < solution.farkas.size(); ++k)
        if (solution.farkas[k] != 0) excluding.push_back(rows[static_cast<std::size_t>(k)]);
      return excluding;
    }
    change = solution.q;
    state.v(search.free()) = v0 + change;
  }
  return {};
}

/// The rows that are held with equality and whose gradient at the position is nothing beside that at other
/// positions, while d²f/dt² at the velocity, to which no acceleration adds, is not 0.
std::vector<Index> singular_rows(const LagrangianSystem& system, const PositionSearch& search,
                                 const TriedPosition& found, const State& state) {
  std::vector<Index> rows;
  Vector beside = found.q;
  for (const Index i : search.free()) beside[i] += std::max(1.0, std::abs(beside[i]));
  try {
    const TriedPosition there = search.at(beside);
    for (Index a = 0; a < found.f.size(); ++a)
      if (search.is_equal(a) && found.U.row(a).norm() < not_found * there.U.row(a).norm()) rows.push_back(a);
    if (rows.empty()) return {};
    const Vector s = system.contact_rows(state, rows).s;
    const double speed = state.v.norm() / std::max(1.0, state.q.norm());
    std::vector<Index> left;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (std::abs(s[static_cast<Index>(k)]) >
          not_found * there.U.row(rows[k]).norm() * speed * state.v.norm())
        left.push_back(rows[k]);
    return left;
  } catch (const convex::InvalidInput&) {  // not finite beside the position: nothing is told
    return {};
  }
}

/// Whether the velocity does what constraint a asks of it.
bool keeps_rate(const PositionSearch& search, const ConstraintRates& rates, Index a) {
  const double least = -not_found * rates.df_scale[a];
  if (search.is_equal(a)) return std::abs(rates.df[a]) <= -least;
  return rates.f[a] > not_found * rates.f_scale[a] || rates.df[a] >= least;
}

double residual_of(const LagrangianSystem& system, const PositionSearch& search, const State& state) {
  const ConstraintRates rates = system.constraint_rates(state);
  double worst = 0;
  for (Index a = 0; a < rates.f.size(); ++a) {
    const double f = rates.f[a] / rates.f_scale[a], df = rates.df[a] / rates.df_scale[a];
    if (search.is_equal(a))
      worst = std::max({worst, std::abs(f), std::abs(df)});
    else
      worst = std::max({worst, -f, f <= not_found ? -df : 0.0});
  }
  return worst;
}

}  // namespace

Assembly assemble(const LagrangianSystem& system, const State& guess, const AssemblyQuestion& question) {
  PositionSearch search(system, guess, question);
  Assembly found;
  found.state = guess;
  if (search.free().empty() || guess.q.size() == 0) {
    const TriedPosition here = search.at(guess.q);
    found.status = here.missing <= not_found ? AssemblyStatus::solved : AssemblyStatus::infeasible;
    for (Index a = 0; a < here.f.size(); ++a)
      if (std::abs(search.violation(here, a)) > not_found * here.scale[a]) found.fighting.push_back(a);
    found.proved =
        found.status == AssemblyStatus::infeasible && is_proved(system, search, guess, found.fighting);
    found.residual = residual_of(system, search, found.state);
    if (found.status == AssemblyStatus::infeasible) return found;
    const ConstraintRates rates = system.constraint_rates(guess);
    for (Index a = 0; a < here.f.size(); ++a)
      if (!keeps_rate(search, rates, a)) found.fighting.push_back(a);
    found.are_rates = !found.fighting.empty();
    if (found.are_rates) found.status = AssemblyStatus::infeasible;
    return found;
  }
  const TriedPosition best = feasible(search, guess, most_starts);
  found.state.q = best.q;
  found.moved = search.moved(best);
  if (best.missing > not_found) {
    found.status = AssemblyStatus::infeasible;
    found.residual = best.missing;
    find_fighters(system, search, guess, best, found);
    return found;
  }
  found.fighting = set_velocity(system, search, found.state);
  found.are_rates = !found.fighting.empty();
  found.residual = residual_of(system, search, found.state);
  if (found.fighting.empty()) found.singular = singular_rows(system, search, best, found.state);
  const bool is_met = found.residual <= not_found && best.step <= not_found && found.singular.empty();
  found.status = !found.fighting.empty() ? AssemblyStatus::infeasible
                 : is_met                ? AssemblyStatus::solved
                                         : AssemblyStatus::gave_up;
  return found;
}

}  // namespace mechanics
