#include "convex/nearest_point/methods/interior_point.hpp"

#include <cmath>

#include "convex/nearest_point/methods/iteration.hpp"
#include "convex/nearest_point/reductions/scaled_problem.hpp"
#include "convex/nearest_point/sparse/regularised_kkt.hpp"

namespace convex {
namespace {

/// Added to Theta, rows being of length 1.
constexpr double regularisation = 1e-11;

/// The part of the step to the boundary that is taken.
constexpr double inside = 0.995;

/// Theta is kept within this of 1: beyond, factors lose all digits.
constexpr double widest = 1e14;

constexpr Index most_steps = 120;

class InteriorPoint {
 public:
  explicit InteriorPoint(const ScaledProblem& scaled)
      : problem_(scaled.problem), two_sided_(scaled.two_sided), kkt_(problem_) {
    const Index m = problem_.rows();
    for (Index a = 0; a < m; ++a) rows_.push_back(a);
    q_ = problem_.A.solve(problem_.z);
    lambda_ = Vector::Zero(m);
    w_ = problem_.U.times(q_) - problem_.s;
    for (Index a = 0; a < m; ++a) {
      if (is_two_sided(a)) {
        w_[a] = 0;
      } else {
        w_[a] = std::max(w_[a], 1.0);
        lambda_[a] = 1;
      }
    }
  }

  /// One step; true when the barrier is down to rounding.
  bool step() {
    const Index m = problem_.rows();
    Vector theta(m);
    for (Index a = 0; a < m; ++a)
      theta[a] =
          regularisation + (is_two_sided(a) ? 0.0 : std::clamp(w_[a] / lambda_[a], 1 / widest, widest));
    if (!kkt_.factor(rows_, theta)) return true;
    const Vector r1 = problem_.z + problem_.U.transpose_times(lambda_) - problem_.A.multiply(q_);
    const Vector r2 = problem_.s + w_ - problem_.U.times(q_);
    Vector dq, dlambda, dw;
    // Predictor: complementarity to 0.
    direction(r1, r2, -w_.cwiseProduct(lambda_), theta, dq, dlambda, dw);
    const double before = barrier(), reach = longest(dlambda, dw);
    double after = 0;
    Index count = 0;
    for (Index a = 0; a < m; ++a)
      if (!is_two_sided(a)) {
        after += (lambda_[a] + reach * dlambda[a]) * (w_[a] + reach * dw[a]);
        ++count;
      }
    after /= static_cast<double>(std::max<Index>(1, count));
    const double centring = before > 0 ? std::pow(std::max(0.0, after) / before, 3) : 0;
    Vector complement(m);
    for (Index a = 0; a < m; ++a)
      complement[a] = is_two_sided(a) ? 0 : centring * before - w_[a] * lambda_[a] - dw[a] * dlambda[a];
    direction(r1, r2, complement, theta, dq, dlambda, dw);
    const double length = std::min(1.0, inside * longest(dlambda, dw));
    q_ += length * dq;
    lambda_ += length * dlambda;
    w_ += length * dw;
    return barrier() < 1e-20;
  }

  const Vector& q() const { return q_; }
  const Vector& lambda() const { return lambda_; }

 private:
  bool is_two_sided(Index a) const { return two_sided_[static_cast<std::size_t>(a)]; }

  /// A dq - Uᵀdlambda = r1, U dq - dw = r2, w dlambda + lambda dw = complement; once refined.
  void direction(const Vector& r1, const Vector& r2, const Vector& complement, const Vector& theta,
                 Vector& dq, Vector& dlambda, Vector& dw) const {
    Vector right = r2;
    for (Index a = 0; a < right.size(); ++a)
      if (!is_two_sided(a)) right[a] += complement[a] / lambda_[a];
    kkt_.solve(r1, right, dq, dlambda);
    for (int pass = 0; pass < 2; ++pass) {
      const Vector left1 = r1 - problem_.A.multiply(dq) + problem_.U.transpose_times(dlambda);
      Vector left2 = right - problem_.U.times(dq);
      for (Index a = 0; a < right.size(); ++a)
        left2[a] -= is_two_sided(a) ? 0 : (theta[a] - regularisation) * dlambda[a];
      Vector more_q, more_lambda;
      kkt_.solve(left1, left2, more_q, more_lambda);
      if (!more_q.allFinite() || !more_lambda.allFinite()) break;
      dq += more_q;
      dlambda += more_lambda;
    }
    dw = problem_.U.times(dq) - r2;
    for (Index a = 0; a < dw.size(); ++a)
      dw[a] = is_two_sided(a) ? 0 : (complement[a] - w_[a] * dlambda[a]) / lambda_[a];
  }

  double barrier() const {
    double sum = 0;
    Index count = 0;
    for (Index a = 0; a < problem_.rows(); ++a)
      if (!is_two_sided(a)) {
        sum += w_[a] * lambda_[a];
        ++count;
      }
    return sum / static_cast<double>(std::max<Index>(1, count));
  }

  /// The step that keeps w and lambda nonnegative, at most 1.
  double longest(const Vector& dlambda, const Vector& dw) const {
    double step = 1;
    for (Index a = 0; a < problem_.rows(); ++a) {
      if (is_two_sided(a)) continue;
      if (dlambda[a] < 0) step = std::min(step, -lambda_[a] / dlambda[a]);
      if (dw[a] < 0) step = std::min(step, -w_[a] / dw[a]);
    }
    return step;
  }

  const NearestPointProblem& problem_;
  const std::vector<bool>& two_sided_;
  RegularisedKkt kkt_;
  std::vector<Index> rows_;
  Vector q_, lambda_, w_;
};

}  // namespace

Solution interior_point(const NearestPointProblem& problem, const Accuracy& accuracy) {
  validate(problem);
  if (const auto found = without_a_method(problem, "interior-point", accuracy)) return *found;
  const ScaledProblem scaled(problem);
  InteriorPoint method(scaled);
  return iterate(
      problem, accuracy, most_steps, [&](Index) { return method.step(); },
      [&](Index) {
        return Candidate{.method = "interior-point",
                         .q = scaled.motion(method.q()),
                         .lambda = scaled.multipliers(method.lambda()),
                         .farkas = scaled.weights(method.lambda())};
      });
}

}  // namespace convex
