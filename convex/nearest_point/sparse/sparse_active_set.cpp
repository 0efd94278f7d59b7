#include "convex/nearest_point/sparse/sparse_active_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/nearest_point/isotonic/peeling.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/solve_watch.hpp"
#include "convex/nearest_point/sparse/interior_point_start.hpp"
#include "convex/nearest_point/sparse/sparse_contradiction.hpp"
#include "convex/nearest_point/sparse/sparse_refinement.hpp"
#include "convex/nearest_point/sparse/tight_rows.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline sparse {
namespace {

constexpr std::string_view method = "sparse-active-set";

/// What the start is asked for, scaled: mean of multiplier times slack. Each time the rows that it shows
/// prove wrong it is taken closer. The first is a try, made as soon as the rows look steady, which
/// `few_exchanges` of few rows must bring to its end.
constexpr std::array gaps{1e-7, 1e-9, 1e-12, 1e-15, 1e-18};
constexpr int few_exchanges = 3;
constexpr double few_rows = 0.01;

/// Exchanges of rows in a run that did not lower the number of wrong ones.
constexpr int patience = 2;
constexpr int most_exchanges = 60;
/// After these, rows go one at a time, at most so often.
constexpr int most_single = 20;
/// Exchanges from the rows that another method shows to be active: more is that method's own business.
constexpr int most_exchanges_near = 3;

/// A sign that so many roundings of the terms could turn is a rounded datum's, not the problem's.
constexpr double data_roundings = 16;

class SparseActiveSet {
 public:
  SparseActiveSet(const NearestPointProblem& problem, const Accuracy& accuracy)
      : problem_(problem), accuracy_(accuracy), scaled_(balanced_problem(problem)), system_(scaled_) {}

  Solution run(const std::vector<Index>& guess) {
    active_ = marked(problem_.rows(), guess);
    const bool all_two_sided = static_cast<Index>(problem_.two_sided.size()) == problem_.rows();
    if (!guess.empty() || all_two_sided) {
      point_.q = DoubleDoubleVector(problem_.dimension());
      point_.lambda = DoubleDoubleVector(problem_.rows());
      if (exchange(most_exchanges, 1)) return answer();
      if (all_two_sided) return contradicted(point_.lambda.hi.cwiseQuotient(scaled_.multiplier));
    }
    InteriorPointStart start(scaled_, system_,
                             problem_.A.solve(problem_.z).cwiseQuotient(scaled_.coordinate));
    for (std::size_t k = 0; k < gaps.size() && may_go_on(); ++k) {
      const Index before = start.steps();
      const InteriorPointStart::End end = start.approach(gaps[k], k == 0);
      steps_ += start.steps() - before;
      if (end == InteriorPointStart::End::unbounded || (end == InteriorPointStart::End::stalled && k == 0)) {
        Solution refused = contradicted(start.lambda());
        if (refused.status == Status::infeasible) return refused;
      }
      if (start.q().size() != problem_.dimension()) break;
      for (const double part : {0.0, data_roundings * unit_roundoff}) {
        zero_part_ = part;
        take_over(start);
        central_ = zero_part_ == 0;
        if (exchange(k == 0 ? few_exchanges : most_exchanges, k == 0 ? few_rows : 1)) return answer();
        if (k == 0) break;
      }
      zero_part_ = 0;
      if (end == InteriorPointStart::End::stalled || end == InteriorPointStart::End::unbounded) break;
    }
    if (start.q().size() == problem_.dimension()) take_over(start);  // exchanges led away from its rows
    return gave_up();
  }

  Solution run_near(const Vector& q, const std::vector<Index>& rows, const Vector& lambda) {
    active_ = marked(problem_.rows(), rows);
    point_.q = DoubleDoubleVector(q);
    point_.lambda = DoubleDoubleVector(problem_.rows());
    for (const std::vector<Index>* held : {&rows, &problem_.two_sided})
      for (Index a : *held) point_.lambda.hi[a] = lambda[a];
    return exchange(1 + most_exchanges_near, 1) ? answer() : gave_up();
  }

 private:
  /// With the rows that looked active at last: another method starts from them.
  Solution gave_up() const {
    Solution solution;
    solution.method = method;
    solution.steps = steps_;
    for (Index a = 0; a < problem_.rows(); ++a)
      if (active_[static_cast<std::size_t>(a)]) solution.basis.push_back(a);
    solution.farkas = Vector::Zero(problem_.rows());
    return solution;
  }

  void take_over(const InteriorPointStart& start) {
    point_.q = DoubleDoubleVector(Vector(start.q().cwiseProduct(scaled_.coordinate)));
    point_.lambda = DoubleDoubleVector(problem_.rows());
    for (Index a = 0; a < problem_.rows(); ++a) {
      const bool active = start.looks_active(a);
      active_[static_cast<std::size_t>(a)] = active;
      if (active) point_.lambda.hi[a] = start.lambda()[a] * scaled_.multiplier[a];
    }
  }

  bool one_sided(Index a) const { return !scaled_.two_sided[static_cast<std::size_t>(a)]; }

  /// Corrects the point on the active rows, with weights that grow where corrections are slow. False when the
  /// factorisation breaks down.
  bool refine() {
    double delta = first_delta;
    for (int j = central_ ? -1 : 0; j < most_deltas; ++j) {
      const Vector weight = j < 0 ? central_weights(scaled_, rows_, delta, point_)
                                  : even_weights(problem_.rows(), rows_, delta);
      delta_ = 1 / std::max(1.0, largest_entry(weight));
      weight_ = weight;
      if (!refine_rows(problem_, scaled_, system_, rows_, weight, zero_part_, point_)) return false;
      if (point_.converged || point_.wrong_signs) return true;
      if (j >= 0) delta *= smaller_delta;
    }
    return true;
  }

  bool may_go_on() const { return accuracy_.step_limit == 0 || steps_ < accuracy_.step_limit; }

  /// Refines on the active rows and exchanges those of the wrong sign until none is left; false when that
  /// does not lead anywhere, or when more than this part of the rows has the wrong sign.
  bool exchange(int most, double part) {
    const auto bearable = static_cast<Index>(part * static_cast<double>(problem_.rows()));
    Index fewest = problem_.rows() + 1;
    int idle = 0;
    for (int k = 0; k < most && may_go_on(); ++k) {
      rows_.clear();
      for (Index a = 0; a < problem_.rows(); ++a)
        if (active_[static_cast<std::size_t>(a)] || !one_sided(a)) rows_.push_back(a);
      if (!refine()) return false;
      const bool refined = point_.converged;
      Index wrong = judge();
      if (wrong == 0 && refined && (has_weak_ || !degenerate_.empty())) {
        point_.to_the_end = true;
        const bool ended = refine();
        point_.to_the_end = false;
        if (!ended || !point_.converged) return false;
        wrong = judge();
      }
      if (wrong == 0) return refined;
      if (wrong > bearable) return false;
      // Rows that contradict each other by rounding have no right signs.
      if (wrong >= fewest && serious_ == 0 && refined) {
        if (!central_) return true;
        central_ = false;  // or rows that count little are not held well enough
        fewest = problem_.rows() + 1;
        continue;
      }
      if (wrong >= fewest && ++idle > patience + most_single) return false;
      if (idle > patience && wrong > most_single) return false;
      if (idle > patience) {  // one row at a time, the last, which never returns to a set (Murty 1974)
        for (std::size_t j = 0; j + 1 < wrong_.size(); ++j)
          active_[static_cast<std::size_t>(wrong_[j])] = !active_[static_cast<std::size_t>(wrong_[j])];
      }
      fewest = std::min(fewest, wrong);
      ++steps_;
      SolveWatch::tell(method, steps_);
    }
    return false;
  }

  /// Corrects the active rows by the signs of the refined numbers; how many were wrong, of which `serious_`
  /// by more than rounding of the data may do; `doubtful_` is by how much the others were, scaled.
  Index judge() {
    Index wrong = 0;
    serious_ = 0;
    doubtful_ = 0;
    const Vector terms = point_.q.hi.cwiseAbs();
    const double push = largest_entry(point_.lambda.hi.cwiseQuotient(scaled_.multiplier));
    wrong_.clear();
    const auto count = [&](Index a, double by, double size) {
      ++wrong;
      wrong_.push_back(a);
      doubtful_ = std::max(doubtful_, by);
      if (by > data_roundings * unit_roundoff * size) ++serious_;
    };
    const double left = 4 * point_.remaining();
    const double size = std::max(1.0, point_.q.hi.cwiseQuotient(scaled_.coordinate).norm());
    slack_ = Vector::Zero(problem_.rows());
    degenerate_.clear();
    has_weak_ = false;
    for (Index a : rows_) {
      const double lambda = point_.lambda.hi[a] / scaled_.multiplier[a];
      if (std::abs(lambda) <= 4 * point_.last_lambda[a] + left) {
        point_.lambda.hi[a] = point_.lambda.lo[a] = 0;
        has_weak_ = has_weak_ || one_sided(a);
      }
      if (one_sided(a) && point_.lambda.hi[a] < 0) {
        active_[static_cast<std::size_t>(a)] = false;
        point_.lambda.hi[a] = point_.lambda.lo[a] = 0;
        count(a, -lambda, push);
      }
    }
    const std::vector<bool> held = marked(problem_.rows(), rows_);
    for (Index a = 0; a < problem_.rows(); ++a) {
      if (held[static_cast<std::size_t>(a)]) continue;
      slack_[a] = slack(problem_, a, point_.q).value();
      const double over = slack_[a] / scaled_.bound[a];
      if (std::abs(over) <=
          left + std::max(zero_of_pairs, 2 * zero_part_) * (size + std::abs(scaled_.s[a]))) {
        slack_[a] = 0;
        degenerate_.push_back(a);
      }
      if (slack_[a] < 0) {
        active_[static_cast<std::size_t>(a)] = true;
        count(a, -over, std::abs(scaled_.s[a]) + problem_.U.absolute_dot(a, terms) / scaled_.bound[a]);
      }
    }
    std::sort(wrong_.begin(), wrong_.end());
    return wrong;
  }

  Solution contradicted(const Vector& lambda) {
    Solution found = sparse_contradiction(problem_, scaled_, system_, lambda);
    found.method = method;
    found.steps = steps_;
    return found;
  }

  double size_of_q() const { return point_.q.hi.cwiseQuotient(scaled_.coordinate).cwiseAbs().maxCoeff(); }

  Solution answer() {
    Solution solution;
    solution.method = method;
    solution.steps = steps_;
    const double unit =
        scaled_.coordinate.size() > 0 ? scaled_.coordinate[0] * std::sqrt(problem_.A.diagonal()[0]) : 1;
    drop_noise(scaled_, point_);
    solution.q = point_.q.hi;
    solution.lambda = point_.lambda.hi;
    solution.slack = slack_;
    if (rows_left_by_peeling(problem_.U, rows_).empty())
      solution.basis = rows_;  // else they may depend on each other
    solution.acceleration_norm = problem_.A.norm(solution.q);
    solution.force_norm = problem_.A.dual_norm(problem_.z);
    solution.residuals = residuals(problem_, solution);
    // ||lo||_A² <= (largest row sum of the scaled A) Σ a_ii lo_i².
    Vector ones = Vector::Ones(problem_.dimension());
    const double spread = (scaled_.A.cwiseAbs() * ones).maxCoeff();
    solution.rounding = std::sqrt(spread * problem_.A.diagonal().dot(point_.q.lo.cwiseAbs2()));
    // What contradictions of rounding leave undecided, as far as the slowest correction tells the least
    // eigenvalue.
    const double spread_of_units = scaled_.coordinate.maxCoeff() / scaled_.coordinate.minCoeff();
    const double inverse_norm = 2 * spread_of_units / std::sqrt(delta_);
    if (zero_part_ > 0) doubtful_ = std::max(doubtful_, zero_part_ * (1 + size_of_q()));
    solution.error_bound = unit * (2 * point_.remaining() + point_.dropped) + solution.rounding +
                           unit * (point_.rest * point_.contraction + doubtful_) * inverse_norm *
                               std::sqrt(static_cast<double>(rows_.size() + 1));
    const bool is_open = zero_part_ > 0 || doubtful_ > 0 || !solution.is_within(accuracy_);
    const double by_gap = is_open ? bound_by_gap(problem_, solution) : infinity;
    const bool is_sure = by_gap < solution.error_bound;  // whatever rows have to do with each other
    if (is_sure) solution.error_bound = by_gap;
    solution.status = solution.is_within(accuracy_) ? Status::solved : Status::inaccurate;
    // Rows of the working set that contradict each other by rounding: as the numbers stand there may be no
    // such point.
    const bool is_settled = is_sure && solution.status == Status::solved;
    if (!problem_.radii && !is_settled && (zero_part_ > 0 || doubtful_ > 0))
      solution.undecided = open_question::dependence;
    if (solution.undecided.empty())
      solution.undecided = decide_tight_rows({problem_, scaled_, system_, rows_, degenerate_}, point_,
                                             weight_, accuracy_.limit, slack_);
    if (!solution.undecided.empty()) {
      if (solution.undecided != open_question::zero_slacks) solution.status = Status::inaccurate;
      solution.basis = rows_;
    }
    solution.slack = slack_;
    solution.model.islands = {{method, problem_.dimension(), problem_.rows(), 0,
                               static_cast<double>(system_.factorisations()) * system_.flops(),
                               system_.nonzeros()}};
    return solution;
  }

  const NearestPointProblem& problem_;
  const Accuracy accuracy_;
  BalancedProblem scaled_;
  RowSystem system_;
  SparsePoint point_;
  std::vector<bool> active_;
  std::vector<Index> rows_, wrong_, degenerate_;
  Vector slack_, weight_;
  Index steps_ = 0, serious_ = 0;
  bool central_ = false,
       has_weak_ = false;  ///< a one-sided row of the working set whose multiplier counts as 0
  double doubtful_ = 0, zero_part_ = 0, delta_ = first_delta;
};

/// Whether a slack is so small a part of its terms that what is left of the rows of the working set, or that
/// these nearly depend on each other, may have made it of 0.
bool has_tiny_slacks(const NearestPointProblem& problem, const Solution& solved) {
  if (solved.status != Status::solved || problem.radii) return false;
  const Vector magnitude = solved.q.cwiseAbs();
  for (Index a = 0; a < problem.rows(); ++a)
    if (solved.slack[a] > 0 &&
        solved.slack[a] <= held_to * (std::abs(problem.s[a]) + problem.U.absolute_dot(a, magnitude)))
      return true;
  return false;
}

}  // namespace

Solution sparse_active_set_near(const NearestPointProblem& problem, const Vector& q,
                                const std::vector<Index>& rows, const Vector& lambda) {
  return SparseActiveSet(problem, {}).run_near(q, rows, lambda);
}

Solution sparse_active_set(const NearestPointProblem& problem, const Accuracy& accuracy,
                           const std::vector<Index>& guess) {
  validate(problem);
  Solution found = decided_in_fractions(problem, SparseActiveSet(problem, accuracy).run(guess), accuracy);
  if (has_open_zeros(problem, found) || has_tiny_slacks(problem, found))
    return with_signs_of_zeros(problem, std::move(found), accuracy);
  return found;
}

}  // namespace convex::inline sparse
