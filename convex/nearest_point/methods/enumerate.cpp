#include "convex/nearest_point/methods/every_method.hpp"

#include <cmath>

#include "convex/nearest_point/methods/crossover.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"
#include "convex/nearest_point/working_set/dependent_row.hpp"

namespace convex::inline algorithms {
namespace {

/// A set whose point violates nothing by more than this (of the scale of the problem) is judged in twice the
/// precision.
constexpr double nearly_right = 1e-9;
constexpr Index most_certified = 300;

class Enumeration {
 public:
  Enumeration(const NearestPointProblem& problem, const Accuracy& accuracy, Index limit)
      : problem_(problem),
        accuracy_(accuracy),
        set_(problem),
        length_(problem.U.lengths(problem.A.diagonal().cwiseInverse())),
        limit_(limit) {
    const std::vector<bool> two_sided = marked(problem.rows(), problem.two_sided);
    for (Index a = 0; a < problem.rows(); ++a) {
      if (two_sided[at(a)]) {
        WorkingSet::Split split;
        set_.split(a, split);
        if (split.rho > 0) set_.append(a, split, 0);
      } else if (length_[a] > 0) {
        rows_.push_back(a);
      }
    }
  }

  /// Certifies S, then all sets that extend it by rows from `first` on. False to stop.
  bool descend(std::size_t first) {
    if (++steps_ > limit_) return false;
    if (is_right()) return false;
    for (std::size_t k = first; k < rows_.size(); ++k) {
      WorkingSet::Split split;
      set_.split(rows_[k], split);
      if (!(split.rho > 0)) {
        if (contradicts(rows_[k], split)) return false;
        continue;
      }
      set_.append(rows_[k], split, 0);
      const bool goes_on = descend(k + 1);
      set_.remove(set_.size() - 1);
      if (!goes_on) return false;
    }
    return true;
  }

  Solution solution() {
    if (found_.status != Status::solved && found_.status != Status::infeasible) found_ = verdict(nearest_);
    found_.steps = steps_;
    return found_;
  }

 private:
  Solution verdict(const Vector& lambda) const {
    Candidate candidate{.method = "enumerate", .q = {}, .lambda = lambda, .farkas = farkas_};
    candidate.finished = steps_ <= limit_;
    return crossover(problem_, candidate, accuracy_);
  }

  /// Certifies S if its point violates little, or if it is the one that violates least so far.
  bool is_right() {
    set_.solve();
    const double scale = set_.scale(), most = std::max(least_, nearly_right) * scale;
    double worst = 0;
    for (Index k = 0; k < set_.size(); ++k)
      if (set_.one_sided(k)) worst = std::max(worst, -set_.lambda()[k] * set_.factor().length(k));
    if (worst > most) return false;
    const Vector slack = problem_.U.times(set_.point()) - problem_.s;
    for (Index a : rows_)
      if (!set_.holds(a)) worst = std::max(worst, -slack[a] / length_[a]);
    if (worst > most) return false;
    Vector lambda = Vector::Zero(problem_.rows());
    for (Index k = 0; k < set_.size(); ++k) lambda[set_.rows()[at(k)]] = set_.lambda()[k];
    if (scale > 0 && worst / scale < least_) {
      least_ = worst / scale;
      nearest_ = lambda;
    }
    if (worst > nearly_right * scale || ++certified_ > most_certified) return false;
    found_ = verdict(lambda);
    return found_.status == Status::solved || found_.status == Status::infeasible;
  }

  /// Whether row p and the rows that it depends on are a proof that there is no solution.
  bool contradicts(Index p, const WorkingSet::Split& split) {
    const double gap = contradiction(set_, p, split);
    if (!(std::abs(gap) > 0)) return false;
    const Vector weights = contradiction_weights(set_, p, split, gap > 0 ? 1 : -1);
    if (!proves_infeasibility(problem_, weights, 1e3 * set_.scale())) return false;
    farkas_ = weights;
    return true;
  }

  const NearestPointProblem& problem_;
  const Accuracy& accuracy_;
  WorkingSet set_;
  Vector length_;
  Index limit_;
  std::vector<Index> rows_;
  double least_ = std::numeric_limits<double>::infinity();
  Vector nearest_, farkas_;
  Solution found_;
  Index steps_ = 0, certified_ = 0;
};

}  // namespace

Solution enumerate(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "enumerate", accuracy)) return *found;
  const Index limit = accuracy.step_limit > 0 ? accuracy.step_limit : std::numeric_limits<Index>::max();
  Enumeration all(problem, accuracy, limit);
  all.descend(0);
  return all.solution();
}

}  // namespace convex::inline algorithms
