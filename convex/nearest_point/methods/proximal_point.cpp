#include "convex/nearest_point/methods/every_method.hpp"

#include <algorithm>

#include "convex/nearest_point/methods/iteration.hpp"
#include "convex/nearest_point/reductions/scaled_problem.hpp"
#include "convex/nearest_point/sparse/regularised_kkt.hpp"

namespace convex::inline algorithms {
namespace {

/// The augmented Lagrangian of a problem about multipliers lambda with weights 1/theta,
///   ½ q·Aq - z·q + Σ ½/theta (theta lambda_a + s_a - u_a·q)²₊ (no positive part on two-sided rows),
/// strongly convex and piecewise quadratic: minimised over q by Newton's method on its pieces.
class AugmentedLagrangian {
 public:
  explicit AugmentedLagrangian(const ScaledProblem&);

  Vector q, lambda;
  double theta = 1;

  /// One Newton step with the active rows of q; damped by the exact minimum along it when asked. Returns
  /// whether the active rows are those of the step before it: then q is the minimum, and `multipliers` are
  /// the next lambda.
  bool newton_step(bool damped);
  /// lambda_a + (s_a - u_a·q)/theta, its positive part on one-sided rows.
  Vector multipliers() const;

 private:
  std::vector<Index> active() const;
  double line_minimum(const Vector& direction) const;

  const ScaledProblem& scaled_;
  const NearestPointProblem& problem_;
  RegularisedKkt kkt_;
  std::vector<Index> factored_;
  double factored_theta_ = -1;
};

AugmentedLagrangian::AugmentedLagrangian(const ScaledProblem& scaled)
    : q(scaled.problem.A.solve(scaled.problem.z)),
      lambda(Vector::Zero(scaled.problem.rows())),
      scaled_(scaled),
      problem_(scaled.problem),
      kkt_(scaled.problem) {}

std::vector<Index> AugmentedLagrangian::active() const {
  const Vector push = theta * lambda + problem_.s - problem_.U.times(q);
  std::vector<Index> rows;
  for (Index a = 0; a < push.size(); ++a)
    if (push[a] > 0 || scaled_.two_sided[static_cast<std::size_t>(a)]) rows.push_back(a);
  return rows;
}

Vector AugmentedLagrangian::multipliers() const {
  Vector found = lambda + (problem_.s - problem_.U.times(q)) / theta;
  for (Index a = 0; a < found.size(); ++a)
    if (!scaled_.two_sided[static_cast<std::size_t>(a)]) found[a] = std::max(0.0, found[a]);
  return found;
}

bool AugmentedLagrangian::newton_step(bool damped) {
  const std::vector<Index> rows = active();
  if (rows != factored_ || theta != factored_theta_) {
    factored_theta_ = 0;  // where the factor breaks down, none is kept
    if (!kkt_.factor(rows, Vector::Constant(static_cast<Index>(rows.size()), theta))) return false;
    factored_ = rows;
    factored_theta_ = theta;
  }
  const Vector old = lambda(rows);
  // A q - U_Jᵀ y = z, U_J q + theta y = s_J + theta lambda_J, as corrections of q and of y = multipliers().
  Vector y = multipliers()(rows), full = Vector::Zero(lambda.size()), dq, dy, step = Vector::Zero(q.size());
  const Vector bound = problem_.s(rows);
  for (int pass = 0; pass < 2; ++pass) {
    full(rows) = y;
    const Vector at = q + step;
    const Vector r1 = problem_.z + problem_.U.transpose_times(full) - problem_.A.multiply(at);
    const Vector product = problem_.U.times(at);
    const Vector r2 = bound + theta * (old - y) - Vector(product(rows));
    kkt_.solve(r1, r2, dq, dy);
    if (!dq.allFinite()) return false;
    step += dq;
    y += dy;
  }
  q += (damped ? line_minimum(step) : 1.0) * step;
  return active() == rows;
}

/// The root of the derivative of the augmented Lagrangian along the direction: increasing and piecewise
/// linear.
double AugmentedLagrangian::line_minimum(const Vector& direction) const {
  const Vector along = problem_.U.times(direction), push = theta * lambda + problem_.s - problem_.U.times(q);
  const Vector Ad = problem_.A.multiply(direction);
  double slope = Ad.dot(q) - problem_.z.dot(direction), curvature = Ad.dot(direction);
  std::vector<std::pair<double, Index>> kinks;
  for (Index a = 0; a < push.size(); ++a) {
    const bool always = scaled_.two_sided[static_cast<std::size_t>(a)];
    if (always || push[a] > 0 || (push[a] == 0 && along[a] < 0)) {
      slope -= push[a] * along[a] / theta;
      curvature += along[a] * along[a] / theta;
    }
    if (!always && along[a] != 0 && push[a] / along[a] > 0) kinks.emplace_back(push[a] / along[a], a);
  }
  std::sort(kinks.begin(), kinks.end());
  double at = 0;
  for (const auto& [kink, a] : kinks) {
    if (slope + curvature * (kink - at) >= 0) break;
    slope += curvature * (kink - at);
    at = kink;
    // Beyond the kink the row leaves when it was pushed, and comes in when it was not.
    curvature += (push[a] > 0 ? -1 : 1) * along[a] * along[a] / theta;
  }
  return curvature > 0 ? std::max(0.0, at - slope / curvature) : 1;
}

/// Newton steps in all.
constexpr Index most_steps = 2000;

/// theta falls at each new centre, down to the least one; Newton steps about one centre, and those that are
/// not damped.
struct ProximalSteps {
  std::string_view method;
  double theta, fall, least_theta;
  Index undamped, most_for_one;
};

Solution by_proximal_steps(const NearestPointProblem& problem, const Accuracy& accuracy,
                           const ProximalSteps& steps) {
  if (const auto found = without_a_method(problem, steps.method, accuracy)) return *found;
  const ScaledProblem scaled(problem);
  AugmentedLagrangian inner(scaled);
  inner.theta = steps.theta;
  Vector moved = inner.lambda;
  Index since = 0, centres = 0, next = 1;
  return iterate(
      problem, accuracy, most_steps,
      [&](Index) {
        if (!inner.newton_step(since >= steps.undamped) && ++since < steps.most_for_one) return false;
        since = 0;
        const Vector lambda = inner.multipliers();
        moved = lambda - inner.lambda;
        inner.lambda = lambda;
        inner.theta = std::max(steps.least_theta, steps.fall * inner.theta);
        if (++centres < next) return false;
        next = centres + 1 + centres / 4;
        return true;
      },
      [&](Index) { return unscaled(steps.method, scaled, scaled.motion(inner.q), inner.lambda, moved); });
}

}  // namespace

Solution proximal_point(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return by_proximal_steps(problem, accuracy,
                           {.method = "proximal-point",
                            .theta = 1e-3,
                            .fall = 0.1,
                            .least_theta = 1e-8,
                            .undamped = 0,
                            .most_for_one = 100});
}

Solution semismooth_newton(const NearestPointProblem& problem, const Accuracy& accuracy) {
  return by_proximal_steps(problem, accuracy,
                           {.method = "semismooth-newton",
                            .theta = 1e-7,
                            .fall = 1,
                            .least_theta = 1e-7,
                            .undamped = 30,
                            .most_for_one = 300});
}

}  // namespace convex::inline algorithms
