#include "convex/nearest_point/reductions/closed_form.hpp"

#include <cmath>

#include "convex/invariant.hpp"
#include "convex/nearest_point/active_set/refinement.hpp"
#include "convex/nearest_point/optimality/kkt_residual.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline reductions {
namespace {

/// The point with the row of the working set, or without it, and how far it may be off.
struct Point {
  DoubleDoubleVector q, lambda{1};
  Vector last;  ///< the last correction
  double remaining = 0;
  bool converged = false;
};

class ClosedForm {
 public:
  explicit ClosedForm(const NearestPointProblem& problem)
      : problem_(problem), free_norm_(problem.A.dual_norm(problem.z)) {
    if (problem.rows() == 0) return;
    u_ = problem.U.row(0);
    v_ = problem.A.solve(u_);
    square_ = u_.dot(v_);
  }

  bool has_length() const { return std::isnormal(square_); }
  double length() const { return std::sqrt(square_); }
  double free_norm() const { return free_norm_; }

  /// Solves A q - lambda u = z, u·q = s when `held`, else A q = z.
  Point solve(bool held) const {
    Point point;
    point.q = DoubleDoubleVector(problem_.dimension());
    const std::vector<Index> rows = held ? std::vector<Index>{0} : std::vector<Index>{};
    const double scale = std::max(free_norm_, held ? std::abs(problem_.s[0]) / length() : 0.0);
    double previous = scale;
    const double of_A = problem_.A.factor_condition(), of_pull = pull_rounding(of_A, 1);
    // As in refinement.cpp: residuals are rounded once, their terms in twice the precision.
    const double of_residuals = 8 * unit_roundoff * unit_roundoff * of_A * scale;
    double contraction = std::min(trusted_contraction / 2, expected_contraction(of_A, 1, false));
    for (int k = 0; k < most_refinements; ++k) {
      const Vector rest = stationarity_residual(problem_, point.q, rows, point.lambda);
      Vector dq = problem_.A.solve(rest);
      double pull = 0;
      if (held) {
        const double dlambda = (-slack(problem_, 0, point.q).value() - u_.dot(dq)) / square_;
        dq += dlambda * v_;
        pull = std::abs(dlambda) * length();
        point.lambda.add(Vector::Constant(1, dlambda));
      }
      point.q.add(dq);
      const double size = problem_.A.norm(dq), floor = at_rounding * scale;
      point.last = dq;
      if (k > 0 && size > floor) contraction = std::max(contraction, size / previous);
      if (!(contraction < trusted_contraction)) return point;
      point.remaining = size * contraction / (1 - contraction) + of_pull * pull;
      previous = size;
      // What the two parts of a correction cancel to says little of them.
      const bool is_told = of_pull * pull <= enough * scale;
      if (k > 0 && is_told && (size <= floor || point.remaining <= enough * scale)) {
        point.remaining += of_residuals;
        point.converged = true;
        break;
      }
    }
    double dropped = 0;
    for (Index i = 0; i < point.q.size(); ++i)
      if (std::abs(point.q.hi[i]) <= 2 * std::abs(point.last[i])) {
        dropped += problem_.A.diagonal()[i] * point.q.hi[i] * point.q.hi[i];
        point.q.hi[i] = point.q.lo[i] = 0;
      }
    point.remaining += std::sqrt(static_cast<double>(point.q.size()) * dropped);  // ||x||_A² <= n Σ a_ii x_i²
    return point;
  }

  /// Whether the free motion violates the row, or the row is two-sided.
  bool pushes(const Point& free) const {
    if (problem_.rows() == 0) return false;
    if (!problem_.two_sided.empty()) return true;
    const double zero =
        zero_of_pairs * (std::abs(problem_.s[0]) + length() * free_norm_) + 2 * length() * free.remaining;
    return slack(problem_, 0, free.q).value() < -zero;
  }

 private:
  const NearestPointProblem& problem_;
  double free_norm_;
  Vector u_, v_;
  double square_ = 1;
};

}  // namespace

std::optional<Solution> closed_form(const NearestPointProblem& problem, const Accuracy& accuracy) {
  invariant(problem.rows() <= 1, "the closed form is for at most one row");
  const ClosedForm formula(problem);
  if (!formula.has_length()) return std::nullopt;
  Point point = formula.solve(false);
  if (!point.converged) return std::nullopt;
  const bool held = formula.pushes(point);
  if (held) point = formula.solve(true);
  if (!point.converged) return std::nullopt;

  Solution solution;
  solution.method = held ? "closed-form" : "unconstrained";
  solution.q = point.q.hi;
  solution.lambda = Vector::Zero(problem.rows());
  solution.slack = Vector::Zero(problem.rows());
  if (held) {
    solution.lambda[0] = problem.two_sided.empty() ? std::max(0.0, point.lambda.hi[0]) : point.lambda.hi[0];
    solution.basis = {0};
    solution.steps = 1;
  } else if (problem.rows() == 1) {
    const double left = slack(problem, 0, point.q).value();
    const double zero = zero_of_pairs * (std::abs(problem.s[0]) + formula.length() * formula.free_norm()) +
                        2 * formula.length() * point.remaining;
    solution.slack[0] = left > zero ? left : 0;
  }
  solution.acceleration_norm = problem.A.norm(solution.q);
  solution.force_norm = formula.free_norm();
  solution.rounding = rounding_norm(problem, point.q.lo);
  if (problem.A.kind() == MetricKind::diagonal || problem.A.kind() == MetricKind::identity)
    solution.rounding = problem.A.norm(point.q.lo);
  // A slack within its rounding counts as 0: then the row's edge is that close.
  const double edge = problem.rows() == 1
                          ? zero_of_pairs * (std::abs(problem.s[0]) / formula.length() + formula.free_norm())
                          : 0;
  solution.error_bound = 4 * point.remaining + edge + solution.rounding;
  solution.residuals =
      residuals(problem, solution,
                {.length = Vector::Constant(problem.rows(), problem.rows() > 0 ? formula.length() : 0.0)});
  solution.status = solution.is_within(accuracy) ? Status::solved : Status::inaccurate;
  return solution;
}

}  // namespace convex::inline reductions
