#include <doctest/doctest.h>

#include <cmath>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "tests/oracles/nearest_point_error.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_kkt.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Status;
using convex::Vector;
using oracles::Difficulty;
using oracles::few_roundings;
using oracles::scale;

namespace {

NearestPointProblem gaussian(unsigned seed, Index n, Index m) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto fill = [&](auto& M) {
    for (Index i = 0; i < M.size(); ++i) M.data()[i] = normal(generator);
  };
  Matrix B(n, n);
  RowMatrix U(m, n);
  Vector z(n), inside(n), gap(m);
  fill(B);
  fill(U);
  fill(z);
  fill(inside);
  fill(gap);
  const Vector s = U * inside - gap.cwiseAbs();
  return {convex::Metric::dense(B * B.transpose() + Matrix::Identity(n, n)),
          10 * z,
          convex::ConstraintRows(U),
          s,
          {}};
}

}  // namespace

TEST_CASE("planted solutions are found to rounding, whatever the degeneracy") {
  for (Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest,
        Difficulty::two_sided_rows, Difficulty::opposite_rows, Difficulty::sparse_rows})
    for (unsigned seed = 0; seed < 150; ++seed) {
      const Index n = 1 + static_cast<Index>(seed % 25), m = static_cast<Index>((7 * seed) % 60);
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const auto [problem, solution] = oracles::planted_problem(seed, n, m, difficulty);
      const Solution found = convex::active_set(problem);
      REQUIRE(found.status == Status::solved);
      const double unit = scale(problem, solution);
      const double error = problem.A.norm(found.q - solution);
      CHECK(error <= few_roundings * unit);
      CHECK(error <= 10 * found.error_bound + 1e-16 * unit);
      CHECK(found.residuals.feasibility <= few_roundings);
      CHECK(found.residuals.stationarity <= few_roundings);
      CHECK((found.lambda.size() == 0 || problem.two_sided.size() > 0 || found.lambda.minCoeff() >= 0));
    }
}

TEST_CASE("large planted problems with redundant rows are found to rounding") {
  for (Difficulty difficulty : {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows}) {
    const auto [problem, solution] = oracles::planted_problem(5, 200, 400, difficulty);
    const Solution found = convex::active_set(problem);
    REQUIRE(found.status == Status::solved);
    CHECK(problem.A.norm(found.q - solution) <= few_roundings * scale(problem, solution));
  }
}

TEST_CASE("on full-mantissa data the answer is the exact rational solution to a few roundings") {
  for (unsigned seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    const Index n = 3 + static_cast<Index>(seed % 6), m = 2 * n;
    const NearestPointProblem problem = gaussian(seed, n, m);
    const Solution found = convex::active_set(problem);
    REQUIRE(found.status == Status::solved);
    const oracles::RationalPoint exact = oracles::solve_kkt(problem, found.basis);
    REQUIRE(oracles::is_exact_solution(problem, exact));
    const double unit = std::max(found.acceleration_norm, found.force_norm);
    const double error = oracles::relative_error(problem, found.q, exact, unit);
    CHECK(error <= few_roundings);
    CHECK(error * unit <= found.error_bound + 1e-17 * unit);
  }
}

TEST_CASE("rows at any small angle cost no digits, as data of powers of two show") {
  for (int exponent = 10; exponent <= 46; exponent += 4) {
    CAPTURE(exponent);
    const double angle = std::ldexp(1, -exponent);
    for (double side : {1.0, -1.0})
      for (bool dense : {false, true}) {
        RowMatrix U(3, 3);
        U << 1, 0, 0, side, angle, 0, 0, 0, 1;
        Matrix A(3, 3);
        A << 4, 1, 0, 1, 3, 1, 0, 1, 2;
        const Vector x = Eigen::Vector3d(1, 2, 3), lambda = Eigen::Vector3d(5, 3, 2);
        const convex::Metric metric = dense ? convex::Metric::dense(A) : convex::Metric::identity(3);
        const NearestPointProblem problem{
            metric, metric.multiply(x) - U.transpose() * lambda, convex::ConstraintRows(U), U * x, {}};
        const Solution found = convex::active_set(problem);
        REQUIRE(found.status == Status::solved);
        CHECK(metric.norm(found.q - x) <= 4 * std::numeric_limits<double>::epsilon() * scale(problem, x));
      }
  }
}

TEST_CASE("an ill-conditioned matrix of inertia costs no digits where refinement converges") {
  Matrix hadamard = Matrix::Ones(1, 1);
  while (hadamard.rows() < 8) {
    Matrix larger(2 * hadamard.rows(), 2 * hadamard.rows());
    larger << hadamard, hadamard, hadamard, -hadamard;
    hadamard = larger;
  }
  for (int bits = 4; bits <= 48; bits += 4) {
    CAPTURE(bits);
    Vector d(8);
    for (Index i = 0; i < 8; ++i) d[i] = std::ldexp(1, bits * static_cast<int>(i) / 7);
    const Matrix A = hadamard * d.asDiagonal() * hadamard;  // condition 2^bits, exact
    std::mt19937 generator(static_cast<unsigned>(bits));
    RowMatrix U(5, 8);
    for (Index i = 0; i < U.size(); ++i) U.data()[i] = static_cast<double>(generator() % 5) - 2;
    Vector x(8), lambda(5);
    for (Index i = 0; i < 8; ++i) x[i] = static_cast<double>(generator() % 9) - 4;
    lambda << 3, 1, 4, 0, 2;
    Vector s = U * x;
    s[3] -= 3;
    const NearestPointProblem problem{
        convex::Metric::dense(A), A * x - U.transpose() * lambda, convex::ConstraintRows(U), s, {}};
    const Solution found = convex::active_set(problem);
    REQUIRE(found.status == Status::solved);
    CHECK(problem.A.norm(found.q - x) <= few_roundings * scale(problem, x));
  }
}

TEST_CASE("a column of 200 balls with a top a million times as heavy rests, every multiplier to 1e-12") {
  const Index n = 200;
  Vector mass = Vector::Ones(n);
  mass[n - 1] = 1e6;
  RowMatrix U = RowMatrix::Zero(n, n);
  for (Index i = 0; i < n; ++i) {
    U(i, i) = 1;
    if (i > 0) U(i, i - 1) = -1;
  }
  const double g = 9.81;
  for (bool sparse : {false, true}) {
    const convex::ConstraintRows rows =
        sparse ? convex::ConstraintRows(convex::SparseRows(U.sparseView())) : convex::ConstraintRows(U);
    const Solution found =
        convex::active_set({convex::Metric::diagonal(mass), -g * mass, rows, Vector::Zero(n), {}});
    REQUIRE(found.status == Status::solved);
    CHECK(found.q.cwiseAbs().maxCoeff() <= 1e-12 * g);
    double above = 0;
    for (Index i = n - 1; i >= 0; --i) {
      above += g * mass[i];
      CHECK(std::abs(found.lambda[i] - above) <= 1e-12 * above);
    }
  }
}

TEST_CASE("infeasible rows come with weights that a check in fractions accepts") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    const Index n = 2 + static_cast<Index>(seed % 9);
    auto [problem, solution] = oracles::planted_problem(seed, n, n + 3, Difficulty::none);
    // One more row, the opposite of a sum of others, with a bound that contradicts them by 1.
    RowMatrix U(problem.rows() + 1, n);
    U.topRows(problem.rows()) = problem.U.dense();
    U.bottomRows(1) = -(U.row(0) + 2 * U.row(1));
    Vector s(problem.rows() + 1);
    s << problem.s, 1 - problem.s[0] - 2 * problem.s[1];
    const NearestPointProblem contradictory{problem.A, problem.z, convex::ConstraintRows(U), s, {}};
    const Solution found = convex::active_set(contradictory);
    REQUIRE(found.status == Status::infeasible);
    CHECK(oracles::is_farkas_witness(contradictory, found.farkas, 1e-12));
  }
}

TEST_CASE("the projection onto C does not expand distances in the kinetic metric") {
  for (unsigned seed = 0; seed < 30; ++seed) {
    NearestPointProblem problem = gaussian(seed, 12, 20), moved = problem;
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    for (Index i = 0; i < 12; ++i) moved.z[i] += normal(generator);
    const Solution first = convex::active_set(problem), second = convex::active_set(moved);
    const double distance = problem.A.norm(first.q - second.q),
                 forces = problem.A.dual_norm(moved.z - problem.z);
    CHECK(distance <= forces * (1 + 1e-13));
  }
}

TEST_CASE("a guess at the active rows, right or wrong, does not change the answer") {
  for (unsigned seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    const auto [problem, solution] = oracles::planted_problem(seed, 15, 25, Difficulty::sums_of_rows);
    std::mt19937 generator(seed);
    std::vector<Index> guess;
    for (Index a = 0; a < 25; ++a)
      if (generator() % 3 == 0) guess.push_back(a);
    const Solution cold = convex::active_set(problem), warm = convex::active_set(problem, {}, guess);
    REQUIRE(warm.status == Status::solved);
    CHECK(problem.A.norm(cold.q - warm.q) <= few_roundings * scale(problem, solution));
  }
}
