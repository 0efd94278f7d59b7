#include "mechanics/evaluation_error.hpp"

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/multipliers/largest_move.hpp"
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

/// Those of the contacts, and behind them of rows that were added. The row in whose place one was added asks
/// for nothing.
EquationRadii radii_of_all_rows(const WrittenMechanism& written, const std::vector<Index>& contacts,
                                const std::vector<AddedRow>& added,
                                const convex::NearestPointProblem& problem, const Vector& q,
                                const Vector& lambda) {
  const auto count = static_cast<Index>(contacts.size());
  EquationRadii found =
      equation_radii(*written.system, written.state, written.radii, contacts, q, lambda.head(count));
  const Vector root = problem.A.diagonal().cwiseSqrt();
  const double length = root.cwiseProduct(q).norm();
  found.rows.conservativeResize(count + static_cast<Index>(added.size()));
  for (std::size_t k = 0; k < added.size(); ++k) {
    const AddedRow& row = added[k];
    const Index a = count + static_cast<Index>(k);
    found.rows[a] = row.row_radius * length + row.rhs_radius;
    found.balance += std::abs(lambda[a]) * row.row_radius * root;
    const auto main = std::find(contacts.begin(), contacts.end(), row.main);
    if (main != contacts.end()) found.rows[main - contacts.begin()] = 0;
  }
  return found;
}

/// The equations are evaluated once for A, z, U, s and once, in another order, for the radii.
constexpr double evaluations = 2;

}  // namespace

double evaluation_error(const WrittenMechanism& written, const std::vector<Index>& contacts,
                        const std::vector<AddedRow>& added, const convex::NearestPointProblem& problem,
                        const convex::Solution& solution, const convex::Accuracy& accuracy) {
  const EquationRadii equations =
      radii_of_all_rows(written, contacts, added, problem, solution.q, solution.lambda);
  const std::vector<Index> held = rows_held(problem, solution);
  Vector rows(static_cast<Index>(held.size()));
  for (std::size_t k = 0; k < held.size(); ++k) rows[static_cast<Index>(k)] = equations.rows[held[k]];
  constexpr double far_below = 1e-2;
  constexpr Index small_system = 40;
  const Units units = fit_units(problem);
  if (!units.ordinary())
    return evaluations * std::sqrt(units.mass) * units.acceleration *
           convex::largest_move(in_units(problem, units), held,
                                equations.balance / units.mass / units.acceleration,
                                rows / units.gradient / units.acceleration);
  if (problem.dimension() > small_system && rows.isZero(0)) {
    const double coarse = evaluations * convex::largest_move(problem.A, equations.balance);
    if (coarse <= far_below * accuracy.tolerance * std::max(1.0, solution.acceleration_norm)) return coarse;
  }
  return evaluations * convex::largest_move(problem, held, equations.balance, rows);
}

void leave_out_pressing(GaussSolution& found, const WrittenMechanism& written,
                        const std::vector<Index>& contacts, const convex::NearestPointProblem& problem) {
  const Vector& lambda = found.multipliers.least_norm;
  if (std::all_of(found.touching.begin(), found.touching.end(), [&](Index a) { return lambda[a] == 0; }))
    return;
  const EquationRadii equations =
      equation_radii(*written.system, written.state, written.radii, contacts, found.primal.q, lambda);
  leave_out_pressing(found.touching, problem, found.primal, found.multipliers,
                     evaluations * equations.balance);
}

void count_evaluation_error(convex::Solution& solution, double error, const convex::Accuracy& accuracy) {
  solution.error_bound += error;
  const double most = accuracy.tolerance * std::max(1.0, solution.acceleration_norm);
  if (solution.status == convex::Status::solved && !(solution.error_bound <= most))
    solution.status = convex::Status::inaccurate;
}

}  // namespace mechanics
