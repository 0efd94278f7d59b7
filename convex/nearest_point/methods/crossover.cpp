#include "convex/nearest_point/methods/crossover.hpp"

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/active_set/active_set_answer.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"
#include "convex/nearest_point/working_set/working_set.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline algorithms {
namespace {

/// Rows that may change while the active rows are held: those whose sign a converged iteration leaves open,
/// many where multipliers and slacks are both small.
Index most_changes(Index held) { return std::min<Index>(32, 2 + held / 2); }

class Crossover {
 public:
  Crossover(const NearestPointProblem& problem, const Candidate& candidate, const Accuracy& accuracy)
      : problem_(problem),
        candidate_(candidate),
        accuracy_(accuracy),
        row_scale_(problem.U.lengths(problem.A.diagonal().cwiseInverse())),
        two_sided_(marked(problem.rows(), problem.two_sided)),
        z_norm_(problem.A.dual_norm(problem.z)) {}

  Solution verdict() {
    if (std::optional<Solution> proved = infeasible(candidate_.farkas)) return *proved;
    Vector lambda = signed_right(candidate_.lambda);
    Vector q = candidate_.q.size() > 0 ? candidate_.q
                                       : problem_.A.solve(problem_.z + problem_.U.transpose_times(lambda));
    if (!q.allFinite() || !lambda.allFinite()) {
      q = problem_.A.solve(problem_.z);
      lambda = Vector::Zero(problem_.rows());
    }
    // Exact lengths cost a solve with A for each row, which is too much for thousands of them.
    Solution raw = measured(problem_, q, lambda, {.length = is_dense_size(problem_) ? Vector() : row_scale_});
    raw.method = candidate_.method;
    raw.steps = candidate_.steps;
    Solution held = active_rows_held(raw);
    if (std::optional<Solution> proved = infeasible(held.farkas); proved && candidate_.may_polish)
      return *proved;
    if (held.q.size() == 0 || held.undecided == open_question::conditioning) {
      raw.error_bound = bound_by_gap(problem_, raw);
      return with_status(raw);
    }
    if (problem_.radii)
      held.undecided = {};  // rows within them are what they are counted as
    else
      held = decided_in_fractions(problem_, std::move(held), accuracy_);
    if (held.status == Status::infeasible) return held;
    if (!held.undecided.empty()) {
      raw.undecided = held.undecided;
      raw.error_bound = infinity;
      return with_status(raw);
    }
    raw.error_bound = held.error_bound + problem_.A.norm(q - held.q);
    held.polished = q != held.q;
    return with_status(candidate_.may_polish && accuracy_.polish ? held : raw);
  }

  std::optional<Solution> infeasible(const Vector& weights) {
    if (weights.size() != problem_.rows() || problem_.rows() == 0 || !weights.allFinite())
      return std::nullopt;
    Vector proof = signed_right(weights);
    if (!(proof.cwiseAbs().maxCoeff() > 0)) return std::nullopt;
    Solution solution;
    if (problem_.radii && is_dense_size(problem_)) {
      std::optional<Vector> proved = contradiction_within_radii(problem_, proof);
      if (!proved) return std::nullopt;
      solution.status = Status::infeasible;
      solution.steps = candidate_.steps;
      solution.farkas = *std::move(proved);
    } else {
      double scale = z_norm_;  // or the size that the rows speak of
      for (Index a = 0; a < problem_.rows(); ++a)
        if (row_scale_[a] > 0) scale = std::max(scale, std::abs(problem_.s[a]) / row_scale_[a]);
      const double reach = farthest_motion * scale;
      std::optional<Vector> circuit;
      if (is_dense_size(problem_)) circuit = farkas_circuit(problem_, proof, reach);
      if (circuit)
        proof = *std::move(circuit);
      else if (!proves_infeasibility(problem_, proof, reach))
        return std::nullopt;
      solution = infeasible_answer(problem_, proof, scale, candidate_.steps, accuracy_);
    }
    solution.method = candidate_.method;
    solution.force_norm = z_norm_;
    if (solution.status != Status::infeasible)
      solution = decided_in_fractions(problem_, std::move(solution), accuracy_);
    return solution.status == Status::infeasible ? std::optional(std::move(solution)) : std::nullopt;
  }

 private:
  Vector signed_right(const Vector& lambda) const {
    Vector clipped = lambda.size() == problem_.rows() ? lambda : Vector(Vector::Zero(problem_.rows()));
    for (Index a = 0; a < clipped.size(); ++a)
      if (!two_sided_[at(a)]) clipped[a] = std::max(0.0, clipped[a]);
    return clipped;
  }

  /// The point of the rows that look active, the most loaded first, as the active set finds it from there.
  Solution active_rows_held(const Solution& raw) const {
    std::vector<Index> rows;
    for (Index a = 0; a < problem_.rows(); ++a)
      if (!two_sided_[at(a)] && row_scale_[a] > 0 && raw.lambda[a] > 0 &&
          raw.lambda[a] * row_scale_[a] > raw.slack[a] / row_scale_[a])
        rows.push_back(a);
    const Vector load = raw.lambda.cwiseProduct(row_scale_);
    std::stable_sort(rows.begin(), rows.end(), [&](Index a, Index b) { return load[a] > load[b]; });
    Solution held = is_dense_size(problem_) ? active_set_near(problem_, rows, raw.lambda,
                                                              most_changes((raw.lambda.array() != 0).count()))
                                            : sparse_active_set_near(problem_, raw.q, rows, raw.lambda);
    held.method = candidate_.method;
    held.steps = candidate_.steps;
    held.model = {};
    return held;
  }

  Solution with_status(Solution solution) const {
    // The lengths of sparse rows may be lower bounds.
    const bool contradicts = !problem_.radii && !problem_.U.is_sparse() && violates_beyond_bound(solution);
    if (!std::isfinite(solution.error_bound) || contradicts) solution.error_bound = infinity;
    solution.status = solution.is_within(accuracy_) ? Status::solved
                      : candidate_.finished         ? Status::inaccurate
                                                    : Status::gave_up;
    return solution;
  }

  const NearestPointProblem& problem_;
  const Candidate& candidate_;
  const Accuracy& accuracy_;
  Vector row_scale_;
  std::vector<bool> two_sided_;
  double z_norm_;
};

}  // namespace

Solution crossover(const NearestPointProblem& problem, const Candidate& candidate, const Accuracy& accuracy) {
  return Crossover(problem, candidate, accuracy).verdict();
}

std::optional<Solution> without_a_method(const NearestPointProblem& problem, std::string_view method,
                                         const Accuracy& accuracy) {
  validate(problem);
  const Index m = problem.rows();
  Candidate candidate{.method = method, .q = {}, .lambda = Vector::Zero(m), .farkas = {}};
  const Vector length = problem.U.lengths(Vector::Ones(problem.dimension()));
  const std::vector<bool> two_sided = marked(m, problem.two_sided);
  for (Index a = 0; a < m; ++a) {
    const bool is_two_sided = two_sided[at(a)];
    if (length[a] > 0 || !(problem.s[a] > 0 || (is_two_sided && problem.s[a] < 0))) continue;
    candidate.farkas = Vector::Zero(m);
    candidate.farkas[a] = problem.s[a] > 0 ? 1 : -1;
    return crossover(problem, candidate, accuracy);
  }
  if (!problem.two_sided.empty() && is_dense_size(problem)) {
    candidate.farkas = active_set_near(problem, {}, candidate.lambda, 0).farkas;
    if (candidate.farkas.size() > 0) return crossover(problem, candidate, accuracy);
  }
  if (length.size() > 0 && length.maxCoeff() > 0) return std::nullopt;
  return crossover(problem, candidate, accuracy);
}

}  // namespace convex::inline algorithms
