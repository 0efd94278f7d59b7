#include "truth.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <stdexcept>

#include "convex/nearest_point/proof/exact_method.hpp"

namespace speed {
namespace {

bool proves_infeasibility(const DenseProblem& problem, const Vector& weights) {
  using Wide = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  if (weights.size() != problem.s.size() || weights.minCoeff() < 0) return false;
  const Wide w = weights.cast<long double>(), s = problem.s.cast<long double>();
  const auto U = problem.U.cast<long double>();
  const Wide left = U.transpose() * w, terms = U.cwiseAbs().transpose() * w;
  return (left.cwiseAbs().array() <= 1e-14L * terms.array()).all() && w.dot(s) > 1e-12L * w.dot(s.cwiseAbs());
}

}  // namespace

convex::NearestPointProblem assembled(const DenseProblem& problem) {
  return {convex::Metric::dense(problem.A), problem.z, convex::ConstraintRows(problem.U), problem.s, {}};
}

Truth truth_of(const DenseProblem& problem) {
  const convex::Solution exact = convex::exact_method(assembled(problem), {});
  Truth truth{exact.status == convex::Status::solved, exact.q, {}};
  for (const Index a : exact.basis)
    if (exact.lambda[a] != 0) truth.rows.push_back(a);
  for (Index a = 0; a < exact.farkas.size(); ++a)
    if (exact.farkas[a] != 0) truth.rows.push_back(a);
  if (problem.planted.size() > 0 &&
      !(truth.feasible && error_of(problem, truth, problem.planted) <= right_to))
    throw std::logic_error("the planted answer is not the exact one");
  return truth;
}

double error_of(const DenseProblem& problem, const Truth& truth, const Vector& q) {
  const Eigen::LLT<Matrix> factor(problem.A);
  const auto length = [&](const Vector& x) { return (factor.matrixU() * x).norm(); };
  const double force = factor.matrixL().solve(problem.z).norm();
  return length(q - truth.q) / std::max(length(truth.q), force);
}

bool is_right(const DenseProblem& problem, const Truth& truth, const convex::Solution& solution) {
  if (!truth.feasible)
    return solution.status == convex::Status::infeasible && proves_infeasibility(problem, solution.farkas);
  return solution.status == convex::Status::solved && error_of(problem, truth, solution.q) <= right_to;
}

}  // namespace speed
