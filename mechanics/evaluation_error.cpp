#include "mechanics/evaluation_error.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "convex/nearest_point/multipliers/largest_move.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "mechanics/data_radii.hpp"
#include "mechanics/touching_contacts.hpp"
#include "mechanics/units.hpp"

namespace mechanics {
namespace {

/// The rows that the answer rests on: its basis, else those with a multiplier and the two-sided ones.
std::vector<Index> rows_held(const convex::NearestPointProblem& problem, const convex::Solution& solution) {
  if (!solution.basis.empty()) return solution.basis;
  std::vector<bool> held(static_cast<std::size_t>(problem.rows()), false);
  for (Index a : problem.two_sided) held[static_cast<std::size_t>(a)] = true;
  std::vector<Index> rows;
  for (Index a = 0; a < problem.rows(); ++a)
    if (held[static_cast<std::size_t>(a)] || solution.lambda[a] != 0) rows.push_back(a);
  return rows;
}

/// The equations of A, z, U, s are those as written, evaluated once more in another order.
constexpr double evaluations = 2;

/// What is left of equations that the answer satisfies as evaluated, as far as is known.
Vector left_of(const RoundedVector& equations) {
  return (evaluations * equations.radius).cwiseMax(equations.value.cwiseAbs() + equations.radius);
}

/// Of the equations at the answer: z + Σ lambda_a u_a - A q'', and by row of the problem; and the rows whose
/// slack there may be negative.
struct LeftOfEquations {
  Vector balance, rows;
  std::vector<Index> open;
};

/// Those of the contacts, and behind them of rows that were added. The row in whose place one was added asks
/// for nothing.
LeftOfEquations left_of_equations(const WrittenMechanism& written, const std::vector<Index>& contacts,
                                  const std::vector<AddedRow>& added,
                                  const convex::NearestPointProblem& problem, const Vector& q,
                                  const Vector& lambda) {
  const auto count = static_cast<Index>(contacts.size());
  EquationsAsWritten found =
      equations_as_written(*written.system, written.state, written.radii, contacts, q, lambda.head(count));
  const Vector root = problem.A.diagonal().cwiseSqrt();
  const double length = root.cwiseProduct(q).norm();
  LeftOfEquations left{{}, left_of(found.rows), {}};
  for (Index a = 0; a < count; ++a)
    if (const double radius = evaluations * found.rows.radius[a]; radius > 0 && found.rows.value[a] <= radius)
      left.open.push_back(a);
  left.rows.conservativeResize(count + static_cast<Index>(added.size()));
  for (std::size_t k = 0; k < added.size(); ++k) {
    const AddedRow& row = added[k];
    const Index a = count + static_cast<Index>(k);
    left.rows[a] = evaluations * (row.row_radius * length + row.rhs_radius);
    found.balance.value += lambda[a] * problem.U.row(a);
    found.balance.radius += std::abs(lambda[a]) * row.row_radius * root;
    const auto main = std::find(contacts.begin(), contacts.end(), row.main);
    if (main != contacts.end()) left.rows[main - contacts.begin()] = 0;
  }
  left.balance = left_of(found.balance);
  return left;
}

/// The rows held, and with them the one-sided ones that the answer may violate: they would hold it where it
/// does.
std::vector<Index> with_open_rows(std::vector<Index> held, const convex::NearestPointProblem& problem,
                                  const std::vector<Index>& open) {
  constexpr double most_work = 1e7;
  const std::vector<bool> known = convex::marked(problem.rows(), held);
  const std::size_t before = held.size();
  for (const Index a : open)
    if (!known[static_cast<std::size_t>(a)] && !problem.is_two_sided(a)) held.push_back(a);
  const double count = static_cast<double>(held.size());
  if (static_cast<double>(problem.dimension()) * count * count > most_work) held.resize(before);
  return held;
}

/// The move of q'' that the rest of the equations amounts to. A one-sided row whose multiplier is no more
/// than its own error may have to open: then those that are held for sure limit the move, for a nearest point
/// follows z no farther than they let it.
double move_of(const convex::NearestPointProblem& problem, const std::vector<Index>& held,
               const Vector& lambda, const LeftOfEquations& left) {
  constexpr double safety = 4;  // multipliers are looked at in some corners only
  const convex::LargestMove move = convex::largest_move(problem, held, left.balance, left.rows(held));
  std::vector<Index> firm;
  for (std::size_t k = 0; k < held.size(); ++k)
    if (problem.is_two_sided(held[k]) ||
        std::abs(lambda[held[k]]) > safety * move.of_multipliers[static_cast<Index>(k)])
      firm.push_back(held[k]);
  if (firm.size() == held.size()) return move.of_point;
  return std::max(move.of_point, convex::largest_move(problem, firm, left.balance, left.rows(firm)).of_point);
}

}  // namespace

double evaluation_error(const WrittenMechanism& written, const std::vector<Index>& contacts,
                        const std::vector<AddedRow>& added, const convex::NearestPointProblem& problem,
                        const convex::Solution& solution, const convex::Accuracy& accuracy) {
  const LeftOfEquations left =
      left_of_equations(written, contacts, added, problem, solution.q, solution.lambda);
  const std::vector<Index> held = with_open_rows(rows_held(problem, solution), problem, left.open);
  constexpr double far_below = 1e-2;
  constexpr Index small_system = 40;
  const Units units = fit_units(problem);
  if (!units.ordinary())
    return std::sqrt(units.mass) * units.acceleration *
           move_of(in_units(problem, units), held,
                   solution.lambda / units.mass / units.acceleration * units.gradient,
                   {left.balance / units.mass / units.acceleration,
                    left.rows / units.gradient / units.acceleration,
                    {}});
  if (problem.dimension() > small_system && left.rows(held).isZero(0)) {
    const double coarse = convex::largest_move(problem.A, left.balance);
    if (coarse <= far_below * accuracy.tolerance * std::max(1.0, solution.acceleration_norm)) return coarse;
  }
  return move_of(problem, held, solution.lambda, left);
}

void leave_out_pressing(GaussSolution& found, const WrittenMechanism& written,
                        const std::vector<Index>& contacts, const convex::NearestPointProblem& problem) {
  const Vector& lambda = found.multipliers.least_norm;
  if (std::all_of(found.touching.begin(), found.touching.end(), [&](Index a) { return lambda[a] == 0; }))
    return;
  const LeftOfEquations left = left_of_equations(written, contacts, {}, problem, found.primal.q, lambda);
  leave_out_pressing(found.touching, problem, found.primal, found.multipliers, left.balance);
}

double force_error(const WrittenMechanism& written, const std::vector<Index>& contacts,
                   const convex::NearestPointProblem& problem, const GaussSolution& found) {
  const LeftOfEquations left =
      left_of_equations(written, contacts, {}, problem, found.primal.q, found.multipliers.least_norm);
  return convex::largest_move(problem.A, left.balance);
}

double hidden_slack(const convex::NearestPointProblem& problem, const convex::Solution& solution, Index a,
                    double length) {
  const double moved = length * solution.error_bound;
  if (!problem.radii) return moved;
  return moved + problem.radii->s[a] + problem.radii->row[a] * solution.acceleration_norm;
}

void leave_out_opening(GaussSolution& found, const convex::NearestPointProblem& problem, double tolerance) {
  const convex::Solution& primal = found.primal;
  const Vector length = convex::dual_lengths(problem, found.touching), magnitude = primal.q.cwiseAbs();
  const auto opens = [&](Index a) {
    const double small = tolerance * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, magnitude)) +
                         hidden_slack(problem, primal, a, length[a]);
    return found.multipliers.least_norm[a] == 0 && primal.slack[a] > small;
  };
  std::vector<Index> open;
  std::copy_if(found.touching.begin(), found.touching.end(), std::back_inserter(open), opens);
  const auto is_open = [&](Index a) { return std::binary_search(open.begin(), open.end(), a); };
  std::erase_if(found.touching, is_open);
  std::erase_if(found.multipliers.tight, is_open);
}

void touch_within_error(GaussSolution& found, const convex::NearestPointProblem& problem, double of_forces) {
  convex::Multipliers& multipliers = found.multipliers;
  std::vector<bool> touches = convex::marked(problem.rows(), found.touching),
                    is_tight = convex::marked(problem.rows(), multipliers.tight);
  std::vector<Index> rows;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!problem.is_two_sided(a) && !touches[static_cast<std::size_t>(a)]) rows.push_back(a);
  const Vector length = convex::dual_lengths(problem, rows);
  for (const Index a : rows) {
    const auto k = static_cast<std::size_t>(a);
    if (!is_tight[k]) {
      touches[k] = is_tight[k] = found.primal.slack[a] <= hidden_slack(problem, found.primal, a, length[a]);
    } else if (multipliers.unique || multipliers.ranges) {
      const double most = multipliers.unique ? multipliers.least_norm[a] : (*multipliers.ranges)[k].high;
      touches[k] = most * length[a] <= of_forces;
    }
    if (!touches[k]) continue;
    found.taken_for_zero += std::abs(multipliers.least_norm[a]) * length[a];
    multipliers.least_norm[a] = 0;
    if (multipliers.ranges) (*multipliers.ranges)[k] = {0, 0};
  }
  if (!multipliers.unique && multipliers.ranges)
    multipliers.unique = std::all_of(multipliers.ranges->begin(), multipliers.ranges->end(),
                                     [](const convex::Interval& range) { return range.low == range.high; });
  found.touching.clear();
  multipliers.tight.clear();
  for (Index a = 0; a < problem.rows(); ++a) {
    if (touches[static_cast<std::size_t>(a)]) found.touching.push_back(a);
    if (is_tight[static_cast<std::size_t>(a)]) multipliers.tight.push_back(a);
  }
}

void accept_where_all_hold(GaussSolution& found, const convex::NearestPointProblem& problem) {
  const convex::Multipliers& multipliers = found.multipliers;
  if (static_cast<Index>(multipliers.tight.size()) != problem.rows() || found.hypothesis.accepted) return;
  found.hypothesis = {};
  found.hypothesis.accepted = true;
  found.hypothesis.two_sided = {true, found.primal.q, multipliers.least_norm, multipliers.unique, false};
}

void count_evaluation_error(convex::Solution& solution, double error, const convex::Accuracy& accuracy) {
  solution.error_bound += error;
  const double most = accuracy.tolerance * std::max(1.0, solution.acceleration_norm);
  if (solution.status == convex::Status::solved && !(solution.error_bound <= most))
    solution.status = convex::Status::inaccurate;
}

}  // namespace mechanics
