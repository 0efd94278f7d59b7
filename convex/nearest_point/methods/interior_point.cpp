#include "convex/nearest_point/methods/every_method.hpp"

#include <cmath>

#include "convex/nearest_point/methods/iteration.hpp"
#include "convex/nearest_point/sparse/mehrotra_step.hpp"
#include "convex/nearest_point/sparse/regularised_kkt.hpp"

namespace convex::inline algorithms {
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
      : problem_(scaled.problem),
        step_(scaled.two_sided),
        kkt_(problem_),
        rows_(indices_below(problem_.rows())) {
    const Index m = problem_.rows();
    at_.q = problem_.A.solve(problem_.z);
    at_.lambda = Vector::Zero(m);
    at_.slack = problem_.U.times(at_.q) - problem_.s;
    for (Index a = 0; a < m; ++a) {
      if (is_two_sided(a)) {
        at_.slack[a] = 0;
      } else {
        at_.slack[a] = std::max(at_.slack[a], 1.0);
        at_.lambda[a] = 1;
      }
    }
  }

  /// One step; true when the barrier is down to rounding.
  bool step() {
    const Index m = problem_.rows();
    Vector theta(m);
    for (Index a = 0; a < m; ++a)
      theta[a] = regularisation +
                 (is_two_sided(a) ? 0.0 : std::clamp(at_.slack[a] / at_.lambda[a], 1 / widest, widest));
    if (!kkt_.factor(rows_, theta)) return true;
    const Vector r1 = problem_.z + problem_.U.transpose_times(at_.lambda) - problem_.A.multiply(at_.q);
    const Vector r2 = problem_.s + at_.slack - problem_.U.times(at_.q);
    step_.take(at_, inside, [&](const Vector& complement, InteriorPointState& to) {
      direction(r1, r2, complement, theta, to.q, to.lambda, to.slack);
    });
    return step_.mean(at_) < 1e-20;
  }

  const Vector& q() const { return at_.q; }
  const Vector& lambda() const { return at_.lambda; }

 private:
  bool is_two_sided(Index a) const { return !step_.one_sided(a); }

  /// A dq - Uᵀdlambda = r1, U dq - dw = r2, w dlambda + lambda dw = complement; once refined.
  void direction(const Vector& r1, const Vector& r2, const Vector& complement, const Vector& theta,
                 Vector& dq, Vector& dlambda, Vector& dw) const {
    Vector right = r2;
    for (Index a = 0; a < right.size(); ++a)
      if (!is_two_sided(a)) right[a] += complement[a] / at_.lambda[a];
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
      dw[a] = is_two_sided(a) ? 0 : (complement[a] - at_.slack[a] * dlambda[a]) / at_.lambda[a];
  }

  const NearestPointProblem& problem_;
  MehrotraStep step_;
  RegularisedKkt kkt_;
  const std::vector<Index> rows_;
  InteriorPointState at_;
};

}  // namespace

Solution interior_point(const NearestPointProblem& problem, const Accuracy& accuracy) {
  if (const auto found = without_a_method(problem, "interior-point", accuracy)) return *found;
  const ScaledProblem scaled(problem);
  InteriorPoint method(scaled);
  return iterate(
      problem, accuracy, most_steps, [&](Index) { return method.step(); },
      [&](Index) {
        return unscaled("interior-point", scaled, scaled.motion(method.q()), method.lambda(),
                        method.lambda());
      });
}

}  // namespace convex::inline algorithms
