#include "convex/nearest_point/multipliers/multipliers.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/active_set/dependence.hpp"
#include "convex/nearest_point/multipliers/coupled_pushes.hpp"
#include "convex/nearest_point/multipliers/least_norm.hpp"
#include "convex/nearest_point/multipliers/multiplier_tableau.hpp"
#include "convex/nearest_point/multipliers/sparse_multipliers.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/exact_dependence.hpp"
#include "convex/nearest_point/reductions/left_out.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline multiplier_sets {
namespace {

/// The tableau of a group of rows, whose multipliers are named by their places in it. Each is measured by the
/// length of its row, so that rows may be told in units far apart.
class MultiplierPolyhedron {
 public:
  MultiplierPolyhedron(const Dependence& rows, const Vector& lambda, const Vector& length,
                       const std::vector<bool>& is_free)
      : names_(rows.basic), length_(length), tableau_(made(rows, lambda, length, is_free, names_)) {}

  /// Of the multiplier times the length of its row.
  Interval range_of_multiplier(Index a) {
    const auto range = tableau_.range(std::find(names_.begin(), names_.end(), a) - names_.begin());
    return {range.low.value_or(-infinity), range.high.value_or(infinity)};
  }
  Interval range(Index a) {
    const Interval range = range_of_multiplier(a);
    return {range.low / length_[a], range.high / length_[a]};
  }
  bool is_in_doubt() const { return tableau_.is_in_doubt(); }

 private:
  static MultiplierTableau<double> made(const Dependence& rows, const Vector& lambda, const Vector& length,
                                        const std::vector<bool>& is_free, std::vector<Index>& names) {
    const std::size_t k = rows.basic.size();
    names.insert(names.end(), rows.dependent.begin(), rows.dependent.end());
    const std::vector<Index> places = indices_below(static_cast<Index>(names.size()));
    std::vector<bool> free;
    for (Index a : names) free.push_back(is_free[at(a)]);
    const auto end_of_basic = places.begin() + static_cast<std::ptrdiff_t>(k);
    const Vector of_basic = length(rows.basic), of_dependent = length(rows.dependent),
                 value = lambda(rows.basic).cwiseProduct(of_basic);
    const Matrix T = of_basic.asDiagonal() * rows.T * of_dependent.cwiseInverse().asDiagonal();
    std::vector<std::vector<double>> columns;
    for (Index j = 0; j < T.cols(); ++j) columns.emplace_back(T.col(j).begin(), T.col(j).end());
    return {{places.begin(), end_of_basic},
            {value.begin(), value.end()},
            {end_of_basic, places.end()},
            std::move(columns),
            std::move(free)};
  }

  std::vector<Index> names_;
  const Vector& length_;
  MultiplierTableau<double> tableau_;
};

/// 1 for a positive multiplier of a one-sided row, else 0. Whether there are other multipliers is a question
/// of directions w, Uᵀw = 0, that leave lambda + t w admissible for small t > 0: w_a >= 0 where lambda_a is
/// 0. The sizes of the positive ones do not enter, however far apart they are.
Vector signs_of(const Vector& lambda, const Vector& length, const Vector& rounding,
                const std::vector<bool>& is_free) {
  Vector signs = Vector::Zero(lambda.size());
  for (Index a = 0; a < lambda.size(); ++a)
    if (!is_free[at(a)] && lambda[a] * length[a] > rounding[a]) signs[a] = 1 / length[a];
  return signs;
}

/// ||u_a||_(A⁻¹) less its part in the rows that the answer rests on: how far a push at the answer can move
/// the slack of row a. At most `length`.
double length_beside_held_rows(const NearestPointProblem& problem, const Solution& solution, Index a,
                               double length) {
  const auto count = static_cast<Index>(solution.basis.size());
  const NearestPointProblem beside{problem.A, problem.U.row(a), problem.U.select(solution.basis),
                                   Vector::Zero(count), indices_below(count)};
  if (count == 0 || !is_dense_size(beside)) return length;
  const Solution found = active_set(beside, {});
  if (found.status != Status::solved) return length;
  return std::min(length, found.acceleration_norm + found.error_bound);
}

}  // namespace

namespace {

/// How far, in the metric, the radii of the rows of the working set may move the point, where these are far
/// from dependent.
double moved_by_radii(const NearestPointProblem& problem, const Solution& solution) {
  if (!problem.radii || problem.radii->is_zero()) return 0;
  const Vector length = dual_lengths(problem, solution.basis);
  double moved = 0;
  for (const Index a : solution.basis)
    if (length[a] > 0)
      moved += (problem.radii->s[a] + problem.radii->row[a] * solution.acceleration_norm) / length[a];
  return moved;
}

}  // namespace

std::vector<Index> tight_rows(const NearestPointProblem& problem, const Solution& solution,
                              double tolerance) {
  const double size = solution.acceleration_norm;
  // An entry of q that is large makes a slack open only where the row has it.
  const double moved = std::min(tolerance * size, solution.error_bound) + moved_by_radii(problem, solution);
  // Where z is rounded, its rounding moves slacks; its size moves none.
  const double pushed =
      problem.radii ? std::min(tolerance, zero_where_z_is_rounded) * solution.force_norm : 0;
  const Vector magnitude = solution.q.cwiseAbs();
  const auto is_small = [&](Index a, double length) {
    const double of_data = problem.radii ? problem.radii->s[a] + problem.radii->row[a] * size : 0;
    const double small = tolerance * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, magnitude)) +
                         moved * length + of_data;
    if (solution.slack[a] <= small) return true;
    return solution.slack[a] <= small + pushed * length &&
           solution.slack[a] <= small + pushed * length_beside_held_rows(problem, solution, a, length);
  };
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  const std::vector<bool> basis = marked(problem.rows(), solution.basis);
  std::vector<Index> candidates;
  for (Index a = 0; a < problem.rows(); ++a)
    if (!two_sided[at(a)] && !basis[at(a)] && !(solution.slack[a] <= 0)) candidates.push_back(a);
  const Vector length = dual_lengths(problem, candidates);
  std::vector<Index> tight;
  for (Index a = 0; a < problem.rows(); ++a)
    if (two_sided[at(a)] || basis[at(a)] || is_small(a, length[a])) tight.push_back(a);
  return tight;
}

namespace {

/// Whether some row that depends on others has a part in lambda: then it is no vertex of the dual optima, as
/// where a method ends between rows that depend on each other.
bool is_no_vertex(const std::vector<Dependence>& groups, const Vector& lambda) {
  return std::any_of(groups.begin(), groups.end(), [&](const Dependence& rows) {
    return std::any_of(rows.dependent.begin(), rows.dependent.end(), [&](Index p) { return lambda[p] != 0; });
  });
}

/// The same answer with the multipliers of a vertex of the dual optima: q is the nearest point of the tight
/// rows alone, too. The answer as it is where they do not give it.
Solution at_vertex(const NearestPointProblem& problem, const std::vector<Index>& tight, Solution solution) {
  const NearestPointProblem held = with_rows(problem, tight);
  if (!is_dense_size(held)) return solution;
  const Solution vertex = active_set(held, {});
  if (vertex.status != Status::solved ||
      !(problem.A.norm(vertex.q - solution.q) <= 2 * (vertex.error_bound + solution.error_bound)))
    return solution;
  solution.lambda.setZero();
  solution.lambda(tight) = vertex.lambda;
  solution.basis.clear();
  for (const Index row : vertex.basis) solution.basis.push_back(tight[at(row)]);
  return solution;
}

/// The solution without what rounding left of the multipliers of rows that open.
Solution off_open_rows(Solution solution, const std::vector<Index>& tight) {
  Vector lambda = Vector::Zero(solution.lambda.size());
  lambda(tight) = solution.lambda(tight);
  solution.lambda = std::move(lambda);
  return solution;
}

bool has_gradient(const NearestPointProblem& problem, Index a) {
  bool has = false;
  problem.U.for_each_entry(a, [&](Index, double u) { has = has || u != 0; });
  return has;
}

/// Whether doubles know T: its zeros are those of the rows as they stand, and roundings of lambda or T grow
/// by no more than `most` in the multipliers.
bool is_known(const NearestPointProblem& problem, const Dependence& rows, const Vector& length, double most) {
  // Beyond, fractions would take too long to make use of it.
  constexpr double most_words = 1e7;
  double growth = rows.inverse_norm;
  for (std::size_t p = 0; p < rows.dependent.size(); ++p)
    for (std::size_t k = 0; k < rows.basic.size(); ++k) {
      const double entry = std::abs(rows.T(static_cast<Index>(k), static_cast<Index>(p)));
      if (entry == 0) continue;
      const double of_unit_rows = entry * length[rows.basic[k]] / length[rows.dependent[p]];
      growth = std::max({growth, entry, rows.inverse_norm * of_unit_rows, 1 / of_unit_rows});
    }
  return growth <= most &&
         depend_as_told(problem, rows.basic, rows.dependent, rows.T, most_words).value_or(true);
}

/// The multipliers over the rows `tight`.
Multipliers multipliers_of(const NearestPointProblem& problem, const Solution& given,
                           const std::vector<Index>& tight, double tolerance, bool want_ranges) {
  Multipliers found;
  found.tight = tight;
  Solution solution = off_open_rows(given, found.tight);
  auto groups = dependences(problem, solution.basis, found.tight);
  // A point may be right and the multipliers that led to it not: those of Delassus' rule, where it hits.
  const bool is_unbalanced = given.residuals.stationarity > tolerance;
  if (groups && (is_unbalanced || is_no_vertex(*groups, solution.lambda))) {
    solution = at_vertex(problem, found.tight, std::move(solution));
    groups = dependences(problem, solution.basis, found.tight);
    if (is_no_vertex(*groups, solution.lambda)) groups.reset();  // there is no table to begin with
  }
  found.least_norm = solution.lambda;
  const std::vector<bool> is_free = marked(problem.rows(), problem.two_sided);
  std::vector<Interval> ranges(at(problem.rows()));
  for (Index a = 0; a < problem.rows(); ++a) ranges[at(a)] = {solution.lambda[a], solution.lambda[a]};
  for (Index a : found.tight) {  // of a row without a gradient any multiplier will do
    if (has_gradient(problem, a)) continue;
    ranges[at(a)] = {is_free[at(a)] ? -infinity : 0, infinity};
    found.unique = false;
  }

  if (!groups) {
    std::vector<Index> loaded, others;
    for (Index a : found.tight)
      if (has_gradient(problem, a))
        (solution.lambda[a] != 0 || is_free[at(a)] ? loaded : others).push_back(a);
    const bool are_others = sparse_rows_are_independent(problem, loaded) && can_open(problem, loaded, others);
    found.unique = found.unique && are_others;
    if (are_others)
      found.ranges = std::move(ranges);
    else if (!least_norm_multipliers(problem, found.tight, found.least_norm) ||
             !is_same_reaction(problem, solution, found.least_norm, tolerance)) {
      found.least_norm = solution.lambda;
      found.is_least_norm = false;
    }
    return found;
  }

  found.null_space = null_space(*groups);
  const bool are_exact = !problem.radii || problem.radii->is_zero();
  if (groups->empty() && are_exact)
    found.is_in_doubt = unit_roundoff * inverse_norm_of_rows(problem, found.tight) > tolerance;
  // They are unique when every dependent row keeps its multiplier 0.
  Vector length = problem.U.lengths(problem.A.diagonal().cwiseInverse());
  length = (length.array() > 0).select(length, 1);
  const CoupledPushes coupled = coupled_pushes(problem, solution, solution.lambda, found.tight, length);
  // Where z is rounded, so are the multipliers that hold against it.
  constexpr double roundings_of_multipliers = 64 * unit_roundoff;
  const Vector rounding = coupled.pushes * (problem.radii ? tolerance : roundings_of_multipliers);
  const Vector signs = signs_of(solution.lambda, length, rounding, is_free);
  std::vector<Dependence> loose;
  for (const Dependence& rows : *groups) {
    // Rows within radii are what they are counted as.
    found.is_in_doubt |= are_exact && !is_known(problem, rows, length, tolerance / roundings_of_multipliers);
    const auto start = std::chrono::steady_clock::now();
    MultiplierPolyhedron directions(rows, signs, length, is_free);
    const bool is_unique = std::none_of(rows.dependent.begin(), rows.dependent.end(), [&](Index p) {
      const Interval range = directions.range_of_multiplier(p);
      return !(range.high - range.low <= tolerance);
    });
    found.is_in_doubt |= are_exact && directions.is_in_doubt();
    if (is_unique) continue;
    found.unique = false;
    if (want_ranges) {
      MultiplierPolyhedron polyhedron(rows, solution.lambda, length, is_free);
      for (Index a : rows.dependent) ranges[at(a)] = polyhedron.range(a);
      for (Index a : rows.basic) ranges[at(a)] = polyhedron.range(a);
      found.is_in_doubt |= are_exact && polyhedron.is_in_doubt();
    }
    found.range_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    loose.push_back(rows);
  }
  if (!least_norm(problem, solution, loose, is_free, tolerance, found.least_norm)) {
    found.least_norm = solution.lambda;
    found.is_least_norm = false;
    found.is_in_doubt = are_exact;
  }
  const bool are_found = std::none_of(ranges.begin(), ranges.end(), [](const Interval& range) {
    return std::isnan(range.low) || std::isnan(range.high);
  });
  // What rounding leaves of rows that hold against nothing is no freedom.
  const double no_push = problem.radii ? zero_where_z_is_rounded : zero_in_doubles;
  if (want_ranges && are_found && !found.unique)
    found.unique = std::all_of(found.tight.begin(), found.tight.end(), [&](Index a) {
      const Interval& range = ranges[at(a)];
      return range.low == range.high || (range.high - range.low) * length[a] <= no_push * coupled.others[a];
    });
  if ((want_ranges && are_found) || found.unique) found.ranges = std::move(ranges);
  return found;
}

/// Of the rows `tight` those that hold: whose slack is no more than the error bound and rounding make of 0.
std::vector<Index> rows_that_hold(const NearestPointProblem& problem, const Solution& solution,
                                  const std::vector<Index>& tight) {
  constexpr double roundings = 16 * unit_roundoff;
  const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
  const std::vector<bool> basis = marked(problem.rows(), solution.basis);
  const Vector length = dual_lengths(problem, tight), size = solution.q.cwiseAbs();
  std::vector<Index> rows;
  for (Index a : tight)
    if (two_sided[at(a)] || basis[at(a)] || solution.lambda[a] != 0 ||
        solution.slack[a] <= length[a] * solution.error_bound +
                                 roundings * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, size)))
      rows.push_back(a);
  return rows;
}

}  // namespace

Multipliers multipliers(const NearestPointProblem& problem, const Solution& given, double tolerance,
                        bool want_ranges) {
  if (given.q.size() != problem.dimension() || given.lambda.size() != problem.rows() ||
      given.slack.size() != problem.rows())
    throw InvalidInput("multipliers: the solution is none of this problem; give one that is solved");
  Multipliers found =
      multipliers_of(problem, given, tight_rows(problem, given, tolerance), tolerance, want_ranges);
  if (problem.radii) return found;
  // A row that opens by less than the tolerance counts as tight, but where a multiplier on it would break
  // lambda_a (u_a·q - s_a) = 0 it has none.
  const std::vector<Index> holding = rows_that_hold(problem, given, found.tight);
  const std::vector<bool> holds = marked(problem.rows(), holding);
  if (std::any_of(found.tight.begin(), found.tight.end(),
                  [&](Index a) { return !holds[at(a)] && found.least_norm[a] != 0; })) {
    std::vector<Index> tight = std::move(found.tight);
    found = multipliers_of(problem, given, holding, tolerance, want_ranges);
    found.tight = std::move(tight);
  }
  return found;
}

}  // namespace convex::inline multiplier_sets
