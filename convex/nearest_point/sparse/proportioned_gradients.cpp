#include "convex/nearest_point/sparse/proportioned_gradients.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace convex::inline sparse {
namespace {

constexpr Index usual_limit = 1500;

/// The objective is watched over so many steps.
constexpr Index watched_steps = 12;

/// After so many, residuals are computed anew: they drift from what is carried along.
constexpr Index steps_between_residuals = 60;

class ProportionedGradients {
 public:
  ProportionedGradients(const NearestPointProblem& problem, const Accuracy& accuracy, const Vector& guess)
      : problem_(problem), accuracy_(accuracy), free_(marked(problem.rows(), problem.two_sided)) {
    if (problem.A.kind() == MetricKind::diagonal) inverse_ = problem.A.diagonal().cwiseInverse();
    scale_ = problem.U.lengths(problem.A.diagonal().cwiseInverse());
    for (double& d : scale_) d = d > 0 ? 1 / d : 0;
    lambda_ = Vector::Zero(problem.rows());
    if (guess.size() == problem.rows())
      for (Index a = 0; a < guess.size(); ++a)
        if (scale_[a] > 0 && (guess[a] > 0 || is_free(a))) lambda_[a] = guess[a] / scale_[a];
  }

  Solution run() {
    find_residual();
    const double longest = longest_step();
    const Index m = problem_.rows();
    Vector p = free_gradient(), Mp(m);
    Vector fallen = Vector::Zero(watched_steps);
    const Index limit = accuracy_.step_limit > 0 ? accuracy_.step_limit : usual_limit;
    Solution solution;
    const double z_norm = std::sqrt(std::max(0.0, problem_.z.dot(by_inverse(problem_.z))));
    double error = std::numeric_limits<double>::infinity();
    Index k = 0;
    for (; k < limit; ++k) {
      double push = 0, reach = 0;  // β·β and φ~·φ
      for (Index a = 0; a < m; ++a) {
        const double g = gradient_[a];
        if (is_free(a))
          reach += g * g;
        else if (lambda_[a] > 0)
          reach += g * std::min(g, lambda_[a] / longest);
        else if (g < 0)
          push += g * g;
      }
      if (push == 0 && reach == 0) {
        error = 0;
        break;
      }
      double fall = 0;
      if (push <= reach) {
        const double curvature = along(p, Mp), slope = gradient_.dot(p);
        if (!(curvature > 0)) break;
        const double step = slope / curvature;
        double feasible = std::numeric_limits<double>::infinity();
        for (Index a = 0; a < m; ++a)
          if (p[a] > 0 && !is_free(a)) feasible = std::min(feasible, lambda_[a] / p[a]);
        if (step <= feasible) {
          move(p, step, Mp);
          fall = 0.5 * step * slope;
          const Vector next = free_gradient();
          p = next - (next.dot(Mp) / curvature) * p;
        } else {
          fall = expand(p, step, longest);
          p = free_gradient();
        }
      } else {
        for (Index a = 0; a < m; ++a)
          p[a] = !is_free(a) && !(lambda_[a] > 0) ? std::min(0.0, gradient_[a]) : 0;
        const double curvature = along(p, Mp), slope = gradient_.dot(p);
        if (!(curvature > 0)) break;
        move(p, slope / curvature, Mp);
        fall = 0.5 * slope * slope / curvature;
        p = free_gradient();
      }
      if (k % steps_between_residuals == steps_between_residuals - 1) find_residual();
      fallen[k % watched_steps] = fall;
      if (k + 1 < watched_steps) continue;
      error = std::sqrt(2 * std::max(0.0, fallen.sum()));
      if (error <= accuracy_.tolerance * std::max(z_norm, problem_.A.norm(q_))) break;
    }
    find_residual();
    solution.method = "proportioned-gradients";
    solution.steps = k;
    solution.q = q_;
    solution.lambda = lambda_.cwiseProduct(scale_);
    solution.slack = gradient_.cwiseQuotient(scale_);
    for (Index a = 0; a < m; ++a)
      if (!(scale_[a] > 0)) solution.slack[a] = -problem_.s[a];
    solution.acceleration_norm = problem_.A.norm(q_);
    solution.force_norm = z_norm;
    solution.error_bound = error;
    const bool is_near = error <= accuracy_.tolerance * std::max(z_norm, solution.acceleration_norm);
    solution.status = is_near ? Status::solved : Status::inaccurate;
    return solution;
  }

 private:
  bool is_free(Index a) const { return free_[at(a)]; }
  Vector by_inverse(const Vector& c) const {
    return inverse_.size() > 0 ? Vector(inverse_.cwiseProduct(c)) : problem_.A.solve(c);
  }
  /// q and the gradient U q - s, in units of the rows, from the multipliers.
  void find_residual() {
    q_ = by_inverse(problem_.z + problem_.U.transpose_times(lambda_.cwiseProduct(scale_)));
    gradient_ = (problem_.U.times(q_) - problem_.s).cwiseProduct(scale_);
  }
  /// p·Mp, with Mp and A⁻¹Uᵀp on the way.
  double along(const Vector& p, Vector& Mp) {
    direction_ = by_inverse(problem_.U.transpose_times(p.cwiseProduct(scale_)));
    problem_.U.times(direction_, Mp);
    Mp = Mp.cwiseProduct(scale_);
    return p.dot(Mp);
  }
  void move(const Vector& p, double step, const Vector& Mp) {
    for (Index a = 0; a < p.size(); ++a) {
      lambda_[a] -= step * p[a];
      if (!is_free(a) && lambda_[a] < 0) lambda_[a] = 0;
    }
    q_ -= step * direction_;
    gradient_ -= step * Mp;
  }
  /// A step of conjugate gradients that leaves the face, projected; or a projected gradient step where that
  /// does not lower the objective. Returns by how much that fell.
  double expand(const Vector& p, double step, double longest) {
    const Vector before = lambda_, gradient = gradient_, q = q_, phi = free_gradient();
    const auto to = [&](const Vector& by, double length) {
      for (Index a = 0; a < by.size(); ++a) {
        lambda_[a] = before[a] - length * by[a];
        if (!is_free(a) && lambda_[a] < 0) lambda_[a] = 0;
      }
      const Vector moved = lambda_ - before;
      q_ = q + by_inverse(problem_.U.transpose_times(moved.cwiseProduct(scale_)));
      gradient_ = (problem_.U.times(q_) - problem_.s).cwiseProduct(scale_);
      return -0.5 * moved.dot(gradient + gradient_);
    };
    const double fall = to(p, step);
    if (fall > 0) return fall;
    return to(phi, longest);
  }
  /// The gradient where a multiplier is free to move.
  Vector free_gradient() const {
    Vector phi = gradient_;
    for (Index a = 0; a < phi.size(); ++a)
      if (!is_free(a) && !(lambda_[a] > 0)) phi[a] = 0;
    return phi;
  }
  /// 1 / ||M||, by powers of M.
  double longest_step() {
    constexpr int powers = 12;
    constexpr double caution = 1.2;
    Vector x(problem_.rows()), Mx(problem_.rows());
    for (Index a = 0; a < x.size(); ++a) x[a] = 1 + 0.5 * static_cast<double>((7 * a) % 11) / 11;
    double norm = 1;
    for (int k = 0; k < powers; ++k) {
      along(x, Mx);
      const double size = Mx.norm();
      if (!(size > 0)) break;
      norm = size / x.norm();
      x = Mx / size;
    }
    return 1 / (caution * norm);
  }

  const NearestPointProblem& problem_;
  const Accuracy& accuracy_;
  std::vector<bool> free_;
  Vector inverse_, scale_;        // of A, if that is diagonal; 1 / ||u_a||
  Vector lambda_, gradient_, q_;  // the first two in units of the rows
  Vector direction_;              // A⁻¹Uᵀp
};

}  // namespace

Solution proportioned_gradients(const NearestPointProblem& problem, const Accuracy& accuracy,
                                const Vector& guess) {
  validate(problem);
  return ProportionedGradients(problem, accuracy, guess).run();
}

}  // namespace convex::inline sparse
