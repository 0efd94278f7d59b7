#include "convex/nearest_point/proof/uncertain_problem.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/proof/exact_method.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::UncertainProblem;
using convex::Vector;

namespace {

struct Sample {
  UncertainProblem uncertain;
  NearestPointProblem middle;
};

/// Every number uncertain by `radius`, but for the rows that are to stay certain.
Sample uncertain(const NearestPointProblem& problem, double radius, const std::vector<Index>& certain) {
  const Index n = problem.dimension(), m = problem.rows();
  UncertainProblem found{convex::exact_problem(problem), Matrix::Constant(n, n, radius),
                         Vector::Constant(n, radius), convex::RowMatrix::Constant(m, n, radius),
                         Vector::Constant(m, radius)};
  for (Index a : certain) {
    found.U.row(a).setZero();
    found.s[a] = 0;
  }
  return {std::move(found), problem};
}

/// A problem at the edge of what is possible: every number moved by its radius, one way or the other.
NearestPointProblem moved(const Sample& sample, unsigned seed) {
  std::mt19937 generator(seed);
  const auto side = [&] { return generator() % 2 == 0 ? 1.0 : -1.0; };
  const NearestPointProblem& middle = sample.middle;
  const UncertainProblem& radii = sample.uncertain;
  Matrix A = middle.A.dense_gram();
  for (Index i = 0; i < A.rows(); ++i)
    for (Index j = 0; j <= i; ++j) A(i, j) = A(j, i) = A(i, j) + side() * radii.A(i, j);
  Vector z = middle.z, s = middle.s;
  convex::RowMatrix U = middle.U.dense();
  for (Index i = 0; i < z.size(); ++i) z[i] += side() * radii.z[i];
  for (Index a = 0; a < s.size(); ++a) {
    s[a] += side() * radii.s[a];
    for (Index i = 0; i < z.size(); ++i) U(a, i) += side() * radii.U(a, i);
  }
  return {convex::Metric::dense(A), z, convex::ConstraintRows(U), s, middle.two_sided};
}

/// Whether ||q* - q||_A <= radius, in fractions but for the last root.
bool lies_within(const NearestPointProblem& problem, const convex::EnclosedSolution& enclosed) {
  const convex::ExactProblem exact = convex::exact_problem(problem);
  const convex::ExactSolution solution = convex::exact_active_set(exact, convex::likely_active_rows(problem));
  REQUIRE(solution.status == convex::Status::solved);
  CHECK(oracles::is_exact_solution(problem,
                                   {oracles::rationals(solution.q), oracles::rationals(solution.lambda)}));
  return convex::root_above(convex::squared_distance(exact, enclosed.q, solution.q)) <= enclosed.radius;
}

}  // namespace

TEST_CASE("the solution of every problem within the radii lies within the radius proved") {
  using oracles::Difficulty;
  int proved = 0;
  // Radii are powers of two, so that the moved data are exact in doubles.
  for (const double radius : {0x1p-40, 0x1p-20})
    for (const Difficulty difficulty : {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows,
                                        Difficulty::at_rest, Difficulty::two_sided_rows})
      for (unsigned seed = 1; seed <= 4; ++seed) {
        CAPTURE(static_cast<int>(difficulty));
        CAPTURE(seed);
        const NearestPointProblem problem = oracles::planted_problem(seed, 5, 6, difficulty).problem;
        const Sample sample = uncertain(problem, radius, {});
        const auto enclosed =
            convex::enclosed_solution(sample.uncertain, convex::likely_active_rows(problem));
        if (!enclosed) continue;
        REQUIRE(enclosed->status == convex::Status::solved);
        ++proved;
        for (unsigned k = 0; k < 6; ++k) CHECK(lies_within(moved(sample, 100 * seed + k), *enclosed));
      }
  CHECK(proved >= 30);
}

TEST_CASE("the radius goes with the root of the uncertainty, so that many bits of data give half as many") {
  const NearestPointProblem problem = oracles::planted_problem(3, 5, 6, oracles::Difficulty::none).problem;
  double before = 0;
  for (const double radius : {0x1p-20, 0x1p-60, 0x1p-200}) {
    const auto enclosed = convex::enclosed_solution(uncertain(problem, radius, {}).uncertain,
                                                    convex::likely_active_rows(problem));
    REQUIRE(enclosed);
    CHECK(enclosed->radius <= 1e4 * std::sqrt(radius));
    CHECK((before == 0 || enclosed->radius < before));
    before = enclosed->radius;
  }
}

TEST_CASE("opposite walls are enclosed when they are certain, and not when their distance is not") {
  // -1 <= q_1 <= -1 in two rows, and a third one across.
  const NearestPointProblem slot{
      convex::Metric::dense((Matrix(2, 2) << 2, 1, 1, 2).finished()),
      Vector::Ones(2),
      convex::ConstraintRows((convex::RowMatrix(3, 2) << 1, 0, -1, 0, 1, 1).finished()),
      (Vector(3) << -1, 1, 2).finished(),
      {}};
  const Sample certain = uncertain(slot, 0x1p-30, {0, 1});
  const auto enclosed = convex::enclosed_solution(certain.uncertain, {0, 2});
  REQUIRE(enclosed);
  for (unsigned k = 0; k < 8; ++k) CHECK(lies_within(moved(certain, k), *enclosed));
  CHECK_FALSE(convex::enclosed_solution(uncertain(slot, 0x1p-30, {}).uncertain, {0, 2}));
}

TEST_CASE(
    "rows that contradict each other by more than their uncertainty are proved to, if their gradients are "
    "certain") {
  const NearestPointProblem walls{convex::Metric::dense(Matrix::Identity(1, 1)),
                                  Vector::Zero(1),
                                  convex::ConstraintRows((convex::RowMatrix(2, 1) << 1, -1).finished()),
                                  (Vector(2) << 1, -0.5).finished(),
                                  {}};
  Sample sample = uncertain(walls, 0x1p-30, {});
  CHECK_FALSE(
      convex::enclosed_solution(sample.uncertain, {}));  // 1.001 q >= 1, 0.999 q <= 0.5: not for certain
  sample.uncertain.U.setZero();
  const auto enclosed = convex::enclosed_solution(sample.uncertain, {});
  REQUIRE(enclosed);
  CHECK(enclosed->status == convex::Status::infeasible);
  CHECK(convex::nearest(convex::ExactVector{enclosed->farkas, 1}) == Vector::Ones(2));
  sample.uncertain.s.setConstant(0.3);  // 1 - 0.3 <= 0.5 + 0.3: they may agree
  CHECK_FALSE(convex::enclosed_solution(sample.uncertain, {}));
}
