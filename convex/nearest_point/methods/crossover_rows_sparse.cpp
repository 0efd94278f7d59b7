#include <algorithm>
#include <cmath>

#include "convex/nearest_point/methods/crossover_rows.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/sparse/sparse_refinement.hpp"
#include "convex/nearest_point/sparse/tight_rows.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline algorithms {
namespace {

/// Times that rows of a wrong sign change sides, all at once.
constexpr int most_exchanges = 3;

class SparsePolish {
 public:
  explicit SparsePolish(const NearestPointProblem& problem)
      : problem_(problem), scaled_(balanced_problem(problem)), system_(scaled_) {}

  Holding run(const Vector& q, const Vector& lambda, const Vector& row_scale) {
    const Vector rest = problem_.U.times(q) - problem_.s;
    std::vector<bool> active = scaled_.two_sided;
    point_.q = DoubleDoubleVector(q);
    point_.lambda = DoubleDoubleVector(problem_.rows());
    for (Index a = 0; a < problem_.rows(); ++a) {
      const auto i = at(a);
      if (!active[i])
        active[i] = row_scale[a] > 0 && lambda[a] > 0 && lambda[a] * row_scale[a] > rest[a] / row_scale[a];
      if (active[i]) point_.lambda.hi[a] = lambda[a];
    }
    Holding found;
    for (int exchange = 0; exchange <= most_exchanges; ++exchange) {
      point_.to_the_end = false;
      rows_.clear();
      for (Index a = 0; a < problem_.rows(); ++a)
        if (active[at(a)]) rows_.push_back(a);
      double delta = first_delta;
      bool refined = false;
      for (int k = 0; k < most_deltas && !refined; ++k, delta *= smaller_delta) {
        weight_ = even_weights(problem_.rows(), rows_, delta);
        if (!refine_rows(problem_, scaled_, system_, rows_, weight_, 0, point_)) return found;
        refined = point_.converged || point_.wrong_signs;
        delta_ = delta;
      }
      if (!refined) return found;
      if (exchange_wrong(active) || point_.wrong_signs) continue;
      if (!degenerate_.empty()) {
        point_.to_the_end = true;
        if (!refine_rows(problem_, scaled_, system_, rows_, weight_, 0, point_) || !point_.converged)
          return found;
        if (exchange_wrong(active)) continue;
      }
      drop_noise(scaled_, point_);
      const std::string_view open =
          decide_tight_rows({problem_, scaled_, system_, rows_, degenerate_}, point_.q, weight_, 1, slack_);
      found.held = held();
      found.held->undecided = open;
      return found;
    }
    return found;
  }

 private:
  /// Whether some sign is wrong beyond what refinement has left; such rows change sides.
  bool exchange_wrong(std::vector<bool>& active) {
    const double left = 4 * point_.remaining();
    const double size = std::max(1.0, point_.q.hi.cwiseQuotient(scaled_.coordinate).norm());
    bool wrong = false;
    slack_ = Vector::Zero(problem_.rows());
    degenerate_.clear();
    for (Index a = 0; a < problem_.rows(); ++a) {
      const auto i = at(a);
      if (active[i]) {
        const double lambda = point_.lambda.hi[a] / scaled_.multiplier[a];
        if (std::abs(lambda) <= 4 * point_.last_lambda[a] + left)
          point_.lambda.hi[a] = point_.lambda.lo[a] = 0;
        if (scaled_.two_sided[i] || !(point_.lambda.hi[a] < 0)) continue;
        point_.lambda.hi[a] = point_.lambda.lo[a] = 0;
        active[i] = false;
        wrong = true;
        continue;
      }
      slack_[a] = slack(problem_, a, point_.q).value();
      if (std::abs(slack_[a]) <=
          scaled_.bound[a] * (left + zero_of_pairs * (size + std::abs(scaled_.s[a])))) {
        slack_[a] = 0;
        degenerate_.push_back(a);
      }
      if (!(slack_[a] < 0)) continue;
      active[i] = true;
      wrong = true;
    }
    return wrong;
  }

  HeldRows held() const {
    const double unit = scaled_.coordinate[0] * std::sqrt(problem_.A.diagonal()[0]);
    const double spread = scaled_.coordinate.maxCoeff() / scaled_.coordinate.minCoeff();
    HeldRows held{rows_, point_.q, point_.lambda.hi, slack_};
    held.remaining = unit * point_.remaining();
    held.inverse_norm = 2 * spread / std::sqrt(delta_);
    held.contradiction =
        unit * point_.rest * point_.contraction * std::sqrt(static_cast<double>(rows_.size() + 1));
    return held;
  }

  const NearestPointProblem& problem_;
  BalancedProblem scaled_;
  RowSystem system_;
  SparsePoint point_;
  std::vector<Index> rows_, degenerate_;
  Vector slack_, weight_;
  double delta_ = first_delta;
};

}  // namespace

Holding hold_active_rows_sparse(const NearestPointProblem& problem, const Vector& q, const Vector& lambda,
                                const Vector& row_scale) {
  return SparsePolish(problem).run(q, lambda, row_scale);
}

}  // namespace convex::inline algorithms
