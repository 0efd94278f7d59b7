#include "convex/nearest_point/automatic.hpp"

#include <algorithm>
#include <cmath>

#include "convex/dense/dense_kernels.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/common_size.hpp"
#include "convex/nearest_point/isotonic/bordered_chain.hpp"
#include "convex/nearest_point/isotonic/chain.hpp"
#include "convex/nearest_point/methods/closed_form.hpp"
#include "convex/nearest_point/methods/every_method.hpp"
#include "convex/nearest_point/obstacle/obstacle.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/reductions/islands.hpp"
#include "convex/nearest_point/reductions/joined_islands.hpp"
#include "convex/nearest_point/reductions/left_out.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"

namespace convex {
namespace {

/// Whether it shows at a glance that all is one dense island.
bool plainly_connected(const NearestPointProblem& problem) {
  if (problem.U.is_sparse()) return false;
  if (problem.A.kind() == MetricKind::dense && (problem.A.dense_gram().col(0).array() != 0).all())
    return true;
  if (problem.dimension() <= 2 || problem.rows() == 0) return false;
  const RowMatrix& U = problem.U.dense();
  return (U.row(0).array() != 0).all() &&
         dense_kernels().first_entries_differ_from_zero(U.rows(), U.cols(), U.data());
}

/// Multiplications of the dense active set: the factor of A, the whitening of the working set, their
/// orthogonal factor.
double dense_flops(const NearestPointProblem& problem, Index held) {
  const double n = static_cast<double>(problem.dimension()), k = static_cast<double>(held);
  const double m = static_cast<double>(problem.rows());
  switch (problem.A.kind()) {
    case MetricKind::dense:
      return n * n * n / 3 + n * n * k + 2 * n * k * k + n * m;
    default:
      return n * k + 2 * n * k * k + n * m;
  }
}

/// From here on the sparse method is faster than the dense one, when at most this part of A and U is there.
constexpr Index sparse_size = 200;
constexpr double sparse_part = 0.05;
/// Up to here the dense method is affordable where the sparse one gives up.
constexpr Index affordable_size = 3000;

Index entries(const NearestPointProblem& problem) {
  const Metric& A = problem.A;
  const Index n = problem.dimension();
  const Index of_A = A.kind() == MetricKind::dense    ? (A.dense_gram().array() != 0).count()
                     : A.kind() == MetricKind::sparse ? A.sparse_gram().nonZeros()
                                                      : n;
  return of_A +
         (problem.U.is_sparse() ? problem.U.sparse().nonZeros() : (problem.U.dense().array() != 0).count());
}

bool is_large_and_sparse(const NearestPointProblem& problem) {
  if (problem.dimension() < sparse_size) return false;
  // A full first column tells a dense A without a look at the rest.
  if (problem.A.kind() == MetricKind::dense && !(problem.A.dense_gram().col(0).array() == 0).any())
    return false;
  const double n = static_cast<double>(problem.dimension()), m = static_cast<double>(problem.rows());
  return static_cast<double>(entries(problem)) <= sparse_part * n * (n + m);
}

/// An answer by special structure; none where its own residuals refute it, so that the structure was none.
std::optional<Solution> borne_out(std::optional<Solution> found) {
  constexpr double far = 1e-3;  // beyond any rounding
  if (!found || found->status != Status::solved) return found;
  const Residuals& of = found->residuals;
  const bool is_near =
      of.feasibility <= far && of.complementarity <= far && of.stationarity <= far && of.duality_gap <= far;
  return is_near ? std::move(found) : std::nullopt;
}

/// What the obstacle method leaves open the others decide where they can.
std::optional<Solution> obstacle_decided(const NearestPointProblem& problem, const Accuracy& accuracy) {
  std::optional<Solution> found = borne_out(solve_obstacle(problem, accuracy));
  if (found && !found->undecided.empty() && problem.dimension() <= affordable_size) return std::nullopt;
  return found;
}

/// The dense active set, with what it cost.
Solution active_set_of_island(const NearestPointProblem& problem, const Accuracy& accuracy,
                              const std::vector<Index>& guess) {
  Solution found = active_set_of_valid(problem, accuracy, guess);
  if (!found.model.islands.empty()) return found;  // fractions said what they did
  const double n = static_cast<double>(problem.dimension()), k = static_cast<double>(found.basis.size());
  Island& island = found.model.islands.emplace_back();
  island.method = found.method;
  island.coordinates = problem.dimension();
  island.rows = problem.rows();
  island.flops = dense_flops(problem, static_cast<Index>(found.basis.size()));
  island.factor_nonzeros = (problem.A.kind() == MetricKind::dense ? n * n / 2 : n) + n * k + k * k / 2;
  return found;
}

Solution solve_connected(const NearestPointProblem& problem, const Accuracy& accuracy,
                         const std::vector<Index>& guess) {
  if (problem.rows() <= 1)
    if (std::optional<Solution> found = closed_form(problem, accuracy);
        found && found->status == Status::solved) {
      const double n = static_cast<double>(problem.dimension());
      const bool dense = problem.A.kind() == MetricKind::dense;
      found->model.islands = {{found->method, problem.dimension(), problem.rows(), 0,
                               dense ? n * n * n / 3 + 4 * n * n : 8 * n, dense ? n * n / 2 : n}};
      found->method = "active-set";  // of which the formula is the case where the first step ends all
      return *std::move(found);
    }
  if (accuracy.reduce && problem.U.is_sparse()) {
    if (std::optional<Solution> found = borne_out(solve_chain(problem, accuracy))) return *std::move(found);
    if (std::optional<Solution> found = obstacle_decided(problem, accuracy)) return *std::move(found);
    if (std::optional<Solution> found = borne_out(solve_bordered_chain(problem, accuracy)))
      return *std::move(found);
  }
  std::vector<Index> likely = guess;
  if (is_large_and_sparse(problem)) {
    // What it leaves open the dense method decides, which sees more before it needs fractions.
    Accuracy own = accuracy;
    if (problem.dimension() <= affordable_size) own.limit = 0;
    Solution found = sparse_active_set(problem, own, guess);
    if (found.status == Status::solved || found.status == Status::infeasible) return found;
    if (problem.dimension() > affordable_size) {
      Solution other = proximal_point(problem, accuracy);
      return other.status == Status::solved || found.status == Status::gave_up ? other : found;
    }
    if (!found.basis.empty()) likely = found.basis;
  }
  return active_set_of_island(problem, accuracy, likely);
}

/// Rows of an island that the free motion keeps were never looked at again.
void name_rows_kept_free(const NearestPointProblem& problem, Solution& solution) {
  if (!solution.basis.empty() || solution.steps > 0 || solution.slack.size() != problem.rows()) return;
  for (Index a = 0; a < problem.rows(); ++a)
    if (solution.slack[a] > 0) solution.model.left_out.push_back({a, LeftOutBecause::free_motion_keeps});
}

Solution solve_all_rows(const NearestPointProblem& problem, const Accuracy& accuracy,
                        const std::vector<Index>& guess) {
  Solution found = solve_connected(problem, accuracy, guess);
  name_rows_kept_free(problem, found);
  return found;
}

/// One island: rows that 0 proves out of reach are taken out first.
Solution solve_island(const NearestPointProblem& problem, const Accuracy& accuracy,
                      const std::vector<Index>& guess) {
  const std::vector<Index> out = rows_out_of_reach(problem);
  if (out.empty()) return solve_all_rows(problem, accuracy, guess);
  std::vector<Index> kept, place(at(problem.rows()), -1);
  for (Index a = 0; a < problem.rows(); ++a)
    if (!std::binary_search(out.begin(), out.end(), a)) {
      place[at(a)] = static_cast<Index>(kept.size());
      kept.push_back(a);
    }
  const NearestPointProblem part = with_rows(problem, kept);
  std::vector<Index> part_guess;
  for (Index a : guess)
    if (place[at(a)] >= 0) part_guess.push_back(place[at(a)]);
  Solution found = solve_all_rows(part, accuracy, part_guess);
  JoinedIslands whole(problem);
  whole.add(std::move(found), indices_below(problem.dimension()), kept);
  for (Index a : out) whole.leave_out(a, LeftOutBecause::out_of_reach);
  return whole.finish(accuracy);
}

std::vector<Index> restricted(const std::vector<Index>& guess, const std::vector<Index>& rows) {
  std::vector<Index> part;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (std::find(guess.begin(), guess.end(), rows[k]) != guess.end()) part.push_back(static_cast<Index>(k));
  return part;
}

Solution solve_islands(const NearestPointProblem& problem, const Islands& islands, const Accuracy& accuracy,
                       const std::vector<Index>& guess) {
  const IslandLists lists = list_islands(islands);
  JoinedIslands whole(problem);
  std::vector<Index> place;
  const auto solve = [&](const std::vector<Index>& coordinates, const std::vector<Index>& rows) {
    const NearestPointProblem part = island_problem(problem, coordinates, rows, place);
    Solution found = solve_island(part, accuracy, guess.empty() ? guess : restricted(guess, rows));
    if (found.status != Status::infeasible && found.status != Status::gave_up)
      whole.add(std::move(found), coordinates, rows);
    else
      whole.fail(std::move(found), rows);
  };
  std::vector<Index> untouched;  // coordinates that no row touches, through A or not, are solved at once
  for (std::size_t k = 0; k < lists.rows.size(); ++k)
    if (lists.rows[k].empty())
      untouched.insert(untouched.end(), lists.coordinates[k].begin(), lists.coordinates[k].end());
  std::sort(untouched.begin(), untouched.end());
  for (std::size_t k = 0; k < lists.rows.size() && !whole.failed(); ++k)
    if (!lists.rows[k].empty()) solve(lists.coordinates[k], lists.rows[k]);
  if (!untouched.empty() && !whole.failed()) solve(untouched, {});
  for (Index a = 0; a < problem.rows(); ++a)
    if (islands.of_row[at(a)] < 0) whole.leave_out(a, LeftOutBecause::no_gradient);
  return whole.finish(accuracy);
}

/// Rows of zeros that no motion can satisfy: to be refused with their witness by the general method.
bool has_contradiction(const NearestPointProblem& problem, const Islands& islands) {
  for (Index a = 0; a < problem.rows(); ++a)
    if (islands.of_row[at(a)] < 0 && (problem.s[a] > 0 || (problem.s[a] < 0 && problem.is_two_sided(a))))
      return true;
  return false;
}

Solution solve_valid(const NearestPointProblem& problem, const Accuracy& accuracy,
                     const std::vector<Index>& guess) {
  if (!accuracy.reduce) return solve_connected(problem, accuracy, guess);
  if (problem.dimension() == 0 || plainly_connected(problem)) return solve_island(problem, accuracy, guess);
  if (std::optional<Solution> chain = borne_out(solve_chain(problem, accuracy)))
    if (problem.rows() > 1) return *std::move(chain);
  if (std::optional<Solution> obstacle = obstacle_decided(problem, accuracy)) return *std::move(obstacle);
  const Islands islands = find_islands(problem);
  if (has_contradiction(problem, islands)) return solve_connected(problem, accuracy, guess);
  const bool whole = islands.count == 1 && std::find(islands.of_row.begin(), islands.of_row.end(),
                                                     Index{-1}) == islands.of_row.end();
  return whole ? solve_island(problem, accuracy, guess) : solve_islands(problem, islands, accuracy, guess);
}

Solution decided(const NearestPointProblem& problem, const Accuracy& accuracy,
                 const std::vector<Index>& guess) {
  Solution found = solve_valid(problem, accuracy, guess);
  if (!found.undecided.empty()) found = bounded_where_decided(problem, std::move(found), accuracy);
  return found;
}

Solution decided_from_nothing(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return decided(problem, accuracy, {});
}

}  // namespace

Solution automatic(const NearestPointProblem& problem, const Accuracy& accuracy,
                   const std::vector<Index>& guess) {
  validate_guess(problem, guess);
  validate(problem);
  // Fractions decide what numbers out of range leave open, where they may: then nothing need be looked at.
  if (accuracy.limit > 0 || has_ordinary_numbers(problem)) {
    Solution found = decided(problem, accuracy, guess);
    if (is_beyond_squares(problem, found)) take_own_size(problem, accuracy, decided_from_nothing, found);
    return found;
  }
  return in_common_size(problem, accuracy, decided_from_nothing);
}

}  // namespace convex
