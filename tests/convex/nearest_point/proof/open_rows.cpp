#include "convex/nearest_point/proof/open_rows.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "convex/nearest_point/proof/exact_dependence.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "tests/oracles/full_mantissa.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Vector;

namespace {

/// ||q - q*||_A, q* by the exact method, which a checker in fractions confirms.
double true_distance(const NearestPointProblem& problem, const Vector& q) {
  const convex::ExactProblem exact = convex::exact_problem(problem);
  const convex::ExactSolution solution = convex::exact_active_set(exact, convex::likely_active_rows(problem));
  REQUIRE(solution.status == convex::Status::solved);
  REQUIRE(oracles::is_exact_solution(problem,
                                     {oracles::rationals(solution.q), oracles::rationals(solution.lambda)}));
  return convex::distance_above(exact, q, solution.q);
}

/// Half of the rows more, each the rounded sum of two rows; with its bound 1e-17 of it above or below their
/// sum.
NearestPointProblem with_rounded_sums(const NearestPointProblem& problem, unsigned seed) {
  std::mt19937 generator(seed);
  const Index m = problem.rows(), more = m / 2;
  RowMatrix U(m + more, problem.dimension());
  Vector s(m + more);
  U.topRows(m) = problem.U.dense();
  s.head(m) = problem.s;
  for (Index k = 0; k < more; ++k) {
    const Index a = static_cast<Index>(generator() % static_cast<unsigned>(m)), b = (a + 1) % m;
    U.row(m + k) = U.row(a) + 0.7 * U.row(b);
    s[m + k] = s[a] + 0.7 * s[b];
  }
  return {problem.A, problem.z, convex::ConstraintRows(U), s, {}};
}

/// Rows that add up to 0, so that each holds with equality wherever all are satisfied, and none of which
/// pushes: 7 times the free motion is made of whole numbers and keeps them, and no doubles do.
NearestPointProblem resting_in_disguise(unsigned seed) {
  std::mt19937 generator(seed);
  const auto whole = [&](unsigned most) {
    return static_cast<double>(generator() % (2 * most + 1)) - static_cast<double>(most);
  };
  const Index n = 3 + seed % 3, m = 2 + seed % 3;
  const Matrix root = Matrix::NullaryExpr(n, n, [&] { return whole(3); });
  const Matrix A = root * root.transpose() + 7 * Matrix::Identity(n, n);
  const Vector q = Vector::NullaryExpr(n, [&] { return whole(9); });
  RowMatrix U = RowMatrix::Zero(m, n);
  for (Index a = 0; a + 1 < m; ++a) {
    for (Index i = 0; i < n; ++i) {
      const Index j = (i + 1 + a) % n;
      const double by = whole(3);
      U(a, i) += by * q[j];
      U(a, j) -= by * q[i];
    }
    U.row(m - 1) -= U.row(a);
  }
  return {convex::Metric::dense(7 * A), A * q, convex::ConstraintRows(U), Vector::Zero(m), {}};
}

constexpr double rounded_up = 1 + 0x1p-40;

}  // namespace

TEST_CASE("a bound is proved in doubles where rows depend on others, exactly or but for rounding") {
  using oracles::Difficulty;
  int proved = 0, all = 0;
  for (const Difficulty difficulty :
       {Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest})
    for (unsigned seed = 1; seed <= 12; ++seed) {
      CAPTURE(static_cast<int>(difficulty));
      CAPTURE(seed);
      const NearestPointProblem problem = oracles::planted_problem(seed, 6, 10, difficulty).problem;
      const Solution solution = convex::active_set(problem);
      ++all;
      const auto bound = convex::enclosed_error(problem, solution);
      if (!bound) continue;
      ++proved;
      CHECK(*bound * rounded_up >= true_distance(problem, solution.q));
      CHECK(*bound <= 1e-9 * std::max(1.0, solution.acceleration_norm));
    }
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = with_rounded_sums(oracles::full_mantissa(seed, 7, 8), seed);
    const Solution solution = convex::automatic(problem);
    ++all;
    const auto bound = convex::enclosed_error(problem, solution);
    if (!bound) continue;
    ++proved;
    CHECK(*bound * rounded_up >= true_distance(problem, solution.q));
    CHECK(*bound <= 1e-9 * std::max(1.0, solution.acceleration_norm));
  }
  MESSAGE("proved " << proved << " of " << all);
  CHECK(proved >= all * 9 / 10);
}

TEST_CASE("rows that are equalities in disguise need not push to be held in a proof") {
  int proved = 0, rounded = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = resting_in_disguise(seed);
    const Solution solution = convex::automatic(problem);
    REQUIRE(solution.status == convex::Status::solved);
    const auto bound = convex::enclosed_error(problem, solution);
    const double off = true_distance(problem, solution.q);
    if (off > 0) ++rounded;
    if (!bound) continue;
    ++proved;
    CHECK(*bound * rounded_up >= off);
  }
  CHECK(proved >= 57);
  CHECK(rounded >= 30);
}

TEST_CASE("a row that is violated is never taken for one that depends on those held") {
  int told = 0;
  for (unsigned seed = 1; seed <= 20; ++seed)
    for (const double by : {1e-3, 1e-7, 1e-11, 1e-14}) {
      CAPTURE(seed);
      CAPTURE(by);
      NearestPointProblem problem = with_rounded_sums(oracles::full_mantissa(seed, 7, 8), seed);
      const Solution solution = convex::active_set(problem);
      if (solution.basis.empty()) continue;
      // A copy of a row held whose bound is higher: the solution is another one.
      RowMatrix U(problem.rows() + 1, problem.dimension());
      U << problem.U.dense(), problem.U.dense().row(solution.basis.front());
      Vector s(problem.rows() + 1);
      s << problem.s, problem.s[solution.basis.front()] + by;
      problem.U = convex::ConstraintRows(U);
      problem.s = s;
      Solution old = solution;
      old.lambda.conservativeResize(problem.rows());
      old.lambda[problem.rows() - 1] = 0;
      const auto bound = convex::enclosed_error(problem, old);
      const double off = true_distance(problem, old.q);
      if (off > 0.1 * by) ++told;
      if (bound) CHECK(*bound * rounded_up >= off);
    }
  CHECK(told >= 40);  // the rows put in do move the solution
}

TEST_CASE("what follows exactly is told from what follows but for rounding") {
  const RowMatrix U{{1, 2, 0},   {0, 3, 1},     {1, 5, 1},          {2, 4, 0},
                    {-1, -2, 0}, {0.1, 0.2, 0}, {1, 5, 1 + 0x1p-52}};
  const Vector s{{1, 2, 3, 2, -1, 0.1, 3}};
  NearestPointProblem problem{convex::Metric::identity(3), Vector::Zero(3), convex::ConstraintRows(U), s, {}};
  const auto follow = [&](convex::Index a, const std::vector<convex::Index>& held) {
    return convex::follow_exactly(problem, {a}, held, 1e6);
  };
  CHECK(follow(2, {0, 1}));
  CHECK(follow(3, {0}));
  CHECK(follow(4, {0}));
  // The double 0.2 is twice the double 0.1, and 0.1 its own bound.
  CHECK(follow(5, {0}));
  CHECK_FALSE(follow(6, {0, 1}));
  CHECK_FALSE(follow(1, {0}));
  problem.s[2] = 3 + 0x1p-51;
  CHECK_FALSE(follow(2, {0, 1}));
  problem.s[2] = 3 - 0x1p-51;
  CHECK(follow(2, {0, 1}));
  problem.two_sided = {2};
  CHECK_FALSE(follow(2, {0, 1}));
}

TEST_CASE(
    "the bound within radii holds for the problems at their corners, and radii that are left out show") {
  int proved = 0, shown = 0;
  for (unsigned seed = 1; seed <= 15; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = seed % 3 == 0
                                            ? with_rounded_sums(oracles::full_mantissa(seed, 5, 6), seed)
                                            : oracles::full_mantissa(seed, 5, 6);
    const Solution solution = convex::active_set(problem);
    const Index n = problem.dimension(), m = problem.rows();
    constexpr double radius = 0x1p-36;
    convex::EntryRadii radii{Matrix(Matrix::Constant(n, n, radius)).sparseView(), Vector::Constant(n, radius),
                             RowMatrix(RowMatrix::Constant(m, n, radius)).sparseView(),
                             Vector::Constant(m, radius)};
    const auto bound = convex::enclosed_error(problem, radii, solution);
    const auto without = convex::enclosed_error(problem, solution);
    if (!bound) continue;
    ++proved;
    std::mt19937 generator(seed);
    const auto side = [&] { return generator() % 2 == 0 ? radius : -radius; };
    for (int corner = 0; corner < 8; ++corner) {
      Matrix A = problem.A.dense_gram();
      for (Index i = 0; i < n; ++i)
        for (Index j = 0; j <= i; ++j) A(i, j) = A(j, i) = A(i, j) + side();
      RowMatrix U = problem.U.dense();
      Vector z = problem.z, s = problem.s;
      for (double& entry : U.reshaped()) entry += side();
      for (double& entry : z) entry += side();
      for (double& entry : s) entry += side();
      const NearestPointProblem moved{convex::Metric::dense(A), z, convex::ConstraintRows(U), s, {}};
      const double distance = true_distance(moved, solution.q);
      CHECK(*bound * rounded_up >= distance);
      if (without && distance > *without) ++shown;
    }
  }
  CHECK(proved >= 10);
  CHECK(shown >= 50);
}
