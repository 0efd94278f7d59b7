#include "tests/stability/naive_methods.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/methods/crossover.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::Vector;

namespace {

/// M = U A⁻¹Uᵀ and U A⁻¹z - s.
struct Delassus {
  Matrix M;
  Vector free;
  explicit Delassus(const NearestPointProblem& problem)
      : M(problem.rows(), problem.rows()), free(problem.U.times(problem.A.solve(problem.z)) - problem.s) {
    for (Index a = 0; a < problem.rows(); ++a) M.col(a) = problem.U.times(problem.A.solve(problem.U.row(a)));
  }
};

Vector motion(const NearestPointProblem& problem, const Vector& lambda) {
  return problem.A.solve(problem.z + problem.U.transpose_times(lambda));
}

/// The multipliers of the rows held, 0 elsewhere.
Vector held(const Delassus& delassus, const std::vector<Index>& rows) {
  const Vector some = Matrix(delassus.M(rows, rows)).llt().solve(-Vector(delassus.free(rows)));
  Vector lambda = Vector::Zero(delassus.free.size());
  lambda(rows) = some;
  return lambda;
}

}  // namespace

namespace naive {

Answer delassus_matrix(const NearestPointProblem& problem, const std::vector<Index>& active) {
  const Vector lambda = held(Delassus(problem), active);
  return {motion(problem, lambda), lambda, true};
}

Answer gauss_seidel(const NearestPointProblem& problem, const StopTest& stops, int most_sweeps) {
  const Delassus delassus(problem);
  const Index m = problem.rows();
  Answer answer{{}, Vector::Zero(m), false};
  for (int sweep = 0; sweep < most_sweeps && !answer.says_solved; ++sweep) {
    const Vector before = answer.lambda;
    for (Index a = 0; a < m; ++a)
      answer.lambda[a] =
          std::max(0.0, answer.lambda[a] -
                            (delassus.M.row(a).dot(answer.lambda) + delassus.free[a]) / delassus.M(a, a));
    const Vector w = delassus.M * answer.lambda + delassus.free;
    answer.says_solved = stops(answer.lambda.cwiseMin(w).cwiseAbs().maxCoeff(),
                               (answer.lambda - before).cwiseAbs().maxCoeff());
  }
  answer.q = motion(problem, answer.lambda);
  return answer;
}

Answer all_at_once(const NearestPointProblem& problem, int most_rounds) {
  const Delassus delassus(problem);
  const Index m = problem.rows();
  std::vector<bool> in(static_cast<std::size_t>(m), false);
  Answer answer{{}, Vector::Zero(m), false};
  for (int round = 0; round < most_rounds && !answer.says_solved; ++round) {
    std::vector<Index> rows;
    for (Index a = 0; a < m; ++a)
      if (in[static_cast<std::size_t>(a)]) rows.push_back(a);
    answer.lambda = held(delassus, rows);
    const Vector w = delassus.M * answer.lambda + delassus.free;
    answer.says_solved = true;
    for (Index a = 0; a < m; ++a) {
      const auto place = static_cast<std::size_t>(a);
      if (in[place] ? answer.lambda[a] >= 0 : w[a] >= 0) continue;
      in[place] = !in[place];
      answer.says_solved = false;
    }
  }
  answer.q = motion(problem, answer.lambda);
  return answer;
}

Answer lemke_by_first_row(const NearestPointProblem& problem, int most_pivots) {
  const Delassus delassus(problem);
  const Index m = problem.rows(), cover = 2 * m, right = 2 * m + 1;
  Matrix T(m, 2 * m + 2);
  T << Matrix::Identity(m, m), -delassus.M, -Vector::Ones(m), delassus.free;
  std::vector<Index> basic(static_cast<std::size_t>(m));
  for (Index i = 0; i < m; ++i) basic[static_cast<std::size_t>(i)] = i;
  Index row = 0, entering = cover;
  const bool started = T.col(right).minCoeff(&row) < 0;
  Answer answer{{}, Vector::Zero(m), !started};
  for (int k = 0; started && k < most_pivots && !answer.says_solved; ++k) {
    const double pivot = T(row, entering);
    T.row(row) /= pivot;
    for (Index i = 0; i < m; ++i) {
      const double factor = T(i, entering);
      if (i != row) T.row(i) -= factor * T.row(row);
    }
    const Index leaving = std::exchange(basic[static_cast<std::size_t>(row)], entering);
    answer.says_solved = leaving == cover;
    entering = leaving < m ? leaving + m : leaving - m;
    row = -1;
    for (Index i = 0; i < m && !answer.says_solved; ++i)
      if (T(i, entering) > 0 && (row < 0 || T(i, right) / T(i, entering) < T(row, right) / T(row, entering)))
        row = i;
    if (row < 0) break;  // a ray
  }
  for (Index i = 0; i < m; ++i)
    if (const Index name = basic[static_cast<std::size_t>(i)]; name >= m && name < cover)
      answer.lambda[name - m] = T(i, right);
  answer.q = motion(problem, answer.lambda);
  return answer;
}

Answer barrier(const NearestPointProblem& problem, double weight) {
  const Index n = problem.dimension(), m = problem.rows();
  // Phase one: push a point out of the rows it violates, a thousand times.
  Vector q = problem.A.solve(problem.z), slack;
  for (int k = 0; k < 1000; ++k) {
    slack = problem.U.times(q) - problem.s;
    Index worst = 0;
    if (slack.minCoeff(&worst) > 0) break;
    const Vector u = problem.U.row(worst), direction = problem.A.solve(u);
    q += 1.5 * (std::abs(slack[worst]) + 1e-9) / u.dot(direction) * direction;
  }
  if (!(slack.minCoeff() > 0)) return {};
  Matrix A(n, n), U(m, n);
  for (Index i = 0; i < n; ++i) A.col(i) = problem.A.multiply(Vector::Unit(n, i));
  for (Index a = 0; a < m; ++a) U.row(a) = problem.U.row(a);
  for (int k = 0; k < 200; ++k) {
    slack = U * q - problem.s;
    const Vector inverse = slack.cwiseInverse();
    const Vector gradient = problem.A.multiply(q) - problem.z - weight * U.transpose() * inverse;
    const Matrix hessian = A + weight * U.transpose() * inverse.cwiseAbs2().asDiagonal() * U;
    const Vector step = -hessian.llt().solve(gradient);
    double t = 1;
    while (t > 1e-12 && (U * (q + t * step) - problem.s).minCoeff() <= 0) t /= 2;
    q += 0.9 * t * step;
  }
  return {q, weight * (U * q - problem.s).cwiseInverse(), true};
}

convex::Status judged(const NearestPointProblem& problem, const Answer& answer) {
  return convex::crossover(problem,
                           {.method = "naive",
                            .q = answer.q,
                            .lambda = answer.lambda,
                            .farkas = {},
                            .finished = answer.says_solved,
                            .may_polish = false},
                           {})
      .status;
}

}  // namespace naive

double true_error(const convex::GalleryInstance& instance, const Vector& q) {
  const convex::Metric& A = instance.problem.A;
  return q.size() == instance.solution.size() && q.allFinite()
             ? A.norm((q - instance.solution.hi) - instance.solution.lo) /
                   oracles::scale(instance.problem, instance.solution.hi)
             : INFINITY;
}

std::vector<Index> loaded_rows(const convex::GalleryInstance& instance) {
  std::vector<Index> rows;
  for (Index a = 0; a < instance.multipliers.size(); ++a)
    if (instance.multipliers[a] > 0) rows.push_back(a);
  return rows;
}

convex::GalleryInstance instance_of(const char* family, Index size, double difficulty) {
  return convex::gallery_instance(*convex::find_family(family), size, difficulty);
}

convex::Solution by_default(const NearestPointProblem& problem) { return convex::automatic(problem, {}); }
