#include "convex/nearest_point/proof/infeasibility_proof.hpp"

#include "tests/convex/nearest_point/pivoting/gram_answer.hpp"

#include <doctest/doctest.h>

#include <optional>
#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "tests/oracles/planted_problem.hpp"

using convex::ConstraintRows;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;
using oracles::Difficulty;

TEST_CASE("where the Gram matrix answers, it is right to rounding, and its bound holds") {
  int answered = 0;
  for (Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest,
        Difficulty::two_sided_rows, Difficulty::opposite_rows, Difficulty::sparse_rows})
    for (unsigned seed = 0; seed < 60; ++seed) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const Index n = 1 + static_cast<Index>((5 * seed) % 37), m = 1 + static_cast<Index>((11 * seed) % 71);
      const auto [problem, truth] = oracles::planted_problem(seed, n, m, difficulty);
      const std::optional<Solution> found = gram_matrix::answer(problem);
      if (!found) continue;
      ++answered;
      CHECK(found->status == Status::solved);
      const double error = problem.A.norm(found->q - truth), unit = gram_matrix::scale(problem, truth);
      CHECK(error <= gram_matrix::few_roundings * unit);
      CHECK(error <= found->error_bound + gram_matrix::few_roundings * unit);
      CHECK(found->residuals.stationarity <= gram_matrix::few_roundings);
      CHECK(found->residuals.feasibility <= gram_matrix::few_roundings);
      CHECK(found->residuals.complementarity <= gram_matrix::few_roundings);
      CHECK(found->lambda.minCoeff() >=
            (difficulty == Difficulty::two_sided_rows ? found->lambda.minCoeff() : 0));
    }
  CHECK(answered > 100);
}

TEST_CASE("the Gram matrix settles well-posed problems, whatever the rows it begins with") {
  const convex::GalleryFamily& family = *convex::find_family("well-posed");
  for (const Index n : {4, 9, 17, 33, 60}) {
    const convex::GalleryInstance instance = convex::gallery_instance(family, n, family.usual);
    const std::optional<Solution> cold = gram_matrix::answer(instance.problem);
    REQUIRE(cold.has_value());
    const std::optional<Solution> warm = gram_matrix::answer(instance.problem, cold->basis);
    REQUIRE(warm.has_value());
    CHECK(warm->q == cold->q);
    CHECK(warm->steps <= cold->steps);
  }
}

TEST_CASE("what the Gram matrix answers of nearly parallel or opposite rows is right") {
  for (const char* name : {"near-parallel", "near-opposite"}) {
    const convex::GalleryFamily& family = *convex::find_family(name);
    for (const double angle : {1e-4, 1e-8, 1e-12}) {
      const convex::GalleryInstance instance = convex::gallery_instance(family, 12, angle);
      const std::optional<Solution> found = gram_matrix::answer(instance.problem);
      if (found)
        CHECK((found->q - instance.solution.hi).norm() <=
              gram_matrix::few_roundings * instance.solution.hi.norm());
    }
  }
}

TEST_CASE("the Gram matrix tells of rows that contradict each other, with a proof") {
  const convex::GalleryFamily& family = *convex::find_family("infeasible");
  int told = 0;
  for (const double margin : family.ladder)
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
      const NearestPointProblem problem = convex::gallery_instance(family, 12, margin, seed).problem;
      const std::optional<Solution> found = gram_matrix::answer(problem);
      if (!found) continue;  // left to the orthogonal factor
      CHECK(found->status == Status::infeasible);
      CHECK(convex::infeasibility_proof(problem, found->farkas).has_value());
      told += 1;
    }
  CHECK(told > 0);
}

TEST_CASE(
    "a row at an angle below rounding to one held with equality, which nothing lets give way, is not called "
    "solved") {
  // x = 0 and x + 2^-39 y >= 0 ask for y >= 0; y weighs so much that in its metric the two rows are one.
  const Matrix A{{1, 0}, {0, 0x1p80}};
  const Matrix U{{1, 0}, {1, 0x1p-39}};
  const Vector z{{1, -0x1p80}};
  const NearestPointProblem problem{Metric::dense(A), z, ConstraintRows(U), Vector::Zero(2), {0}};
  const Solution found = convex::active_set(problem);
  const bool right = std::abs(found.q[1]) <= 1e-15;
  CHECK((right || found.status != Status::solved));
}

TEST_CASE("a multiplier is measured by the length of its own row, however far apart the units of rows are") {
  // Rows 0 and 2 are opposite but for rounding, rows 2 and 3 are told in units 1e27 apart.
  const Matrix A{{96, 1536, 0x1p26, -0x1p15},
                 {1536, 212992, 0, 0},
                 {0x1p26, 0, 914793674309632, 0x1p35},
                 {-0x1p15, 0, 0x1p35, 100663296}};
  const Matrix U{{0.0080000000000000002, -0.25600000000000001, 0, 8.1920000000000002},
                 {-0.0080000000000000002, -0.128, 16777.216, 8.1920000000000002},
                 {-800000000000, 25600000000000, -186.2645149230957, -819200000000000},
                 {0, 0, -9.5367431640625002e-15, 0}};
  const Vector z{{28, -256, 58720256, -16384}};
  const Vector s{
      {-0.0060000000000000001, -0.0070000000000000001, 600000000000.00574, 2.9103830456733704e-19}};
  const Solution found = convex::active_set({Metric::dense(A), z, ConstraintRows(U), s, {}});
  REQUIRE(found.status == Status::solved);
  // In fractions: rows 0, 1 and 2 hold.
  const Vector truth{{-31.51140790736457, 0.09053076981942858, -3.080192e-05, 0.03286952396639286}};
  CHECK((found.q - truth).norm() <= 1e-14 * truth.norm());
  CHECK(std::abs(found.lambda[2] / 209124343.8748531 - 1) <= 1e-12);
}

TEST_CASE("a multiplier that rounding alone makes negative does not hold a row") {
  const Vector masses{{274877906944, 1.1641532182693481e-10, 0.0029296875, 3.7252902984619141e-09}};
  const Matrix U{{1, 2, 0, 0}, {1, 2, -2, 0}, {2, 0, -1, 1}, {-2, 0, 2, -1}, {-2, -1, -1, 2}};
  const Vector z{{6, -6, 3, 0}}, s{{8, 8, 0, -3, -12}};
  const Solution found =
      convex::active_set({Metric::dense(masses.asDiagonal()), z, ConstraintRows(U), s, {}});
  REQUIRE(found.status == Status::solved);
  CHECK(found.lambda[2] == 0);  // in fractions it is -2.4e-19 where row 2 is held with rows 0 and 1
  CHECK(found.slack[2] > 0);
}
