#include "convex/nearest_point/multipliers/multipliers.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "convex/linear_algebra/cholesky.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/methods.hpp"
#include "tests/oracles/planted_problem.hpp"

using convex::Index;
using convex::Interval;
using convex::Multipliers;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;

namespace {

constexpr double tolerance = 1e-9;

Multipliers all_multipliers(const NearestPointProblem& problem) {
  return convex::multipliers(problem, convex::active_set(problem), tolerance, true);
}

/// A table of weight 40 with legs at the corners of a square, loaded at (p, r) from its centre.
NearestPointProblem table(double p, double r) {
  RowMatrix U(4, 3);
  U << 1, 1, 1, 1, 1, -1, 1, -1, -1, 1, -1, 1;
  return {convex::Metric::identity(3),
          Eigen::Vector3d(-40, -40 * p, -40 * r),
          convex::ConstraintRows(U),
          Vector::Zero(4),
          {}};
}

}  // namespace

TEST_CASE("a centred table on four legs: mg/4 each of least norm, anywhere in [0, mg/2]") {
  const Multipliers found = all_multipliers(table(0, 0));
  CHECK_FALSE(found.unique);
  for (Index leg = 0; leg < 4; ++leg) {
    CHECK(found.least_norm[leg] == doctest::Approx(10));
    CHECK((*found.ranges)[static_cast<std::size_t>(leg)].low == doctest::Approx(0));
    CHECK((*found.ranges)[static_cast<std::size_t>(leg)].high == doctest::Approx(20));
  }
}

TEST_CASE("multipliers of dependent rows can be unique: a table that tips stands on two legs") {
  const Multipliers found = all_multipliers(table(1, 0));
  CHECK(found.unique);
  CHECK(found.least_norm[0] == doctest::Approx(20));
  CHECK(found.least_norm[2] == 0);
}

TEST_CASE("contacts that squeeze a body have multipliers without bound") {
  RowMatrix U(2, 1);
  U << 1, -1;
  const NearestPointProblem slot{
      convex::Metric::identity(1), Vector::Constant(1, -5), convex::ConstraintRows(U), Vector::Zero(2), {}};
  const Multipliers found = all_multipliers(slot);
  CHECK_FALSE(found.unique);
  CHECK((*found.ranges)[0].low == doctest::Approx(5));
  CHECK(std::isinf((*found.ranges)[0].high));
  CHECK((*found.ranges)[1].low == doctest::Approx(0));
  CHECK(found.least_norm[0] == doctest::Approx(5));
}

TEST_CASE("repeated two-sided rows have multipliers without bound on both sides") {
  RowMatrix U(2, 1);
  U << 1, 1;
  const NearestPointProblem twice{convex::Metric::identity(1),
                                  Vector::Constant(1, -5),
                                  convex::ConstraintRows(U),
                                  Vector::Zero(2),
                                  {0, 1}};
  const Multipliers found = all_multipliers(twice);
  CHECK(std::isinf((*found.ranges)[0].low));
  CHECK(std::isinf((*found.ranges)[1].high));
  CHECK(found.least_norm[0] == doctest::Approx(2.5));
}

TEST_CASE("the least-norm multipliers balance the forces, lie in their ranges and no others are shorter") {
  for (oracles::Difficulty difficulty :
       {oracles::Difficulty::repeated_rows, oracles::Difficulty::sums_of_rows,
        oracles::Difficulty::opposite_rows})
    for (unsigned seed = 0; seed < 60; ++seed) {
      CAPTURE(seed);
      const auto [problem, x] =
          oracles::planted_problem(seed, 3 + static_cast<Index>(seed % 10), 16, difficulty);
      const convex::Solution solution = convex::active_set(problem);
      const Multipliers found = convex::multipliers(problem, solution, tolerance, true);
      const double size = std::max(1.0, solution.lambda.norm());
      const Vector reaction = problem.A.multiply(x) - problem.z;
      CHECK((problem.U.transpose_times(found.least_norm) - reaction).norm() <= 1e-11 * size);
      CHECK(found.least_norm.minCoeff() >= 0);
      CHECK(found.least_norm.norm() <= solution.lambda.norm() + 1e-12 * size);
      for (Index a = 0; a < problem.rows(); ++a) {
        const Interval range = (*found.ranges)[static_cast<std::size_t>(a)];
        CHECK(range.low <= solution.lambda[a] + 1e-10 * size);
        CHECK(range.high >= solution.lambda[a] - 1e-10 * size);
        CHECK(range.low <= found.least_norm[a] + 1e-10 * size);
        CHECK(range.high >= found.least_norm[a] - 1e-10 * size);
      }
      // The shortest point of a convex set makes an acute angle with every other.
      const double inner = found.least_norm.dot(solution.lambda - found.least_norm);
      CHECK(inner >= -1e-9 * size * size);
    }
}

TEST_CASE("rows on coordinates of their own are ranged by themselves: a hall full of tables") {
  constexpr Index tables = 40;
  RowMatrix U = RowMatrix::Zero(4 * tables, 3 * tables);
  convex::Matrix A = convex::Matrix::Identity(3 * tables, 3 * tables);
  Vector z(3 * tables);
  for (Index k = 0; k < tables; ++k) {
    const NearestPointProblem one = table(0, k % 2 == 0 ? 0.0 : 1.0);
    U.block(4 * k, 3 * k, 4, 3) = one.U.dense();
    z.segment(3 * k, 3) = one.z;
    if (k > 0) A(3 * k, 3 * k - 1) = A(3 * k - 1, 3 * k) = 0.25;  // the floors couple what the legs do not
  }
  // At rest whatever the inertia: z is in the cone of the legs.
  const Multipliers found =
      all_multipliers({convex::Metric::dense(A), z, convex::ConstraintRows(U), Vector::Zero(4 * tables), {}});
  CHECK_FALSE(found.unique);
  REQUIRE(found.null_space);
  CHECK(found.null_space->size() == tables);
  for (Index k = 0; k < tables; ++k) {
    const convex::NullVector& mu = (*found.null_space)[static_cast<std::size_t>(k)];
    REQUIRE(mu.size() == 4);
    Vector sum = Vector::Zero(3 * tables);
    for (const auto& [row, coefficient] : mu) {
      CHECK(row / 4 == k);
      sum += coefficient * U.row(row).transpose();
    }
    CHECK(sum.norm() <= 1e-15);
    for (Index leg = 0; leg < 4; ++leg) {
      const bool is_loaded = k % 2 == 0 || leg == 0 || leg == 3;  // the others tip off
      CAPTURE(k);
      CAPTURE(leg);
      CHECK((*found.ranges)[static_cast<std::size_t>(4 * k + leg)].low == doctest::Approx(k % 2 == 0  ? 0
                                                                                          : is_loaded ? 20
                                                                                                      : 0));
      CHECK((*found.ranges)[static_cast<std::size_t>(4 * k + leg)].high ==
            doctest::Approx(is_loaded ? 20 : 0));
    }
  }
}

TEST_CASE("rows that depend on nearly parallel ones have multipliers of least norm too") {
  RowMatrix U(4, 2);
  U << 1, 0, 1, 0x1p-26, 0, 1, 1, 1;
  const NearestPointProblem corner{convex::Metric::identity(2),
                                   Eigen::Vector2d(-2, -1),
                                   convex::ConstraintRows(U),
                                   Vector::Zero(4),
                                   {0, 1}};
  const Multipliers found = all_multipliers(corner);
  CHECK_FALSE(found.unique);
  CHECK((U.transpose() * found.least_norm - Eigen::Vector2d(2, 1)).norm() <= 1e-7);
  CHECK(found.least_norm.norm() <= std::sqrt(2.0));  // (1, 0, 0, 1) will do
}

TEST_CASE("multipliers of rows told in units far apart are not called unique when they are not") {
  // q = (-1, 2, 1) is the corner of all rows but the third; exact arithmetic on the doubles gives the ranges.
  RowMatrix U(5, 3);
  U << -2e-6, 0, 0, -2, 2, 2, -2147483648, 0, -4294967296, -1e-6, -1e-6, 0, -6e12, 0, -2e12;
  const NearestPointProblem problem{convex::Metric::diagonal(Vector{{1, 1, 2}}),
                                    Vector{{1.0000152587890625, 2.000015251338482, 2}},
                                    convex::ConstraintRows(U),
                                    Vector{{2e-6, 8, -2147483652, -1e-6, 4e12}},
                                    {}};
  // The third row is open by 4, of terms of 8e9.
  constexpr double fine = 1e-12;
  const Multipliers found = convex::multipliers(problem, convex::active_set(problem), fine, true);
  CHECK_FALSE(found.unique);
  REQUIRE(found.ranges.has_value());
  const double highest[] = {1000000.0037252903, 0.20000000074505805, 0, 400015.252828598,
                            2.0000000074505805e-13};
  for (Index a = 0; a < 5; ++a) {
    const Interval& range = (*found.ranges)[static_cast<std::size_t>(a)];
    CHECK(range.high == doctest::Approx(highest[a]).epsilon(1e-9));
    CHECK(found.least_norm[a] >= range.low * (1 - 1e-9));
    CHECK(found.least_norm[a] <= range.high * (1 + 1e-9));
  }
  const Vector reaction = problem.A.multiply(Vector{{-1, 2, 1}}) - problem.z;
  CHECK((U.transpose() * found.least_norm - reaction).norm() <= 1e-9 * reaction.norm());
}

TEST_CASE("forces that cancel make no row tight that is open by as much as its bound") {
  // Two rows press with 2^40 against each other's load; the third is open by 3.
  RowMatrix U(3, 2);
  U << 1, 0, 0, 1, 1, 1;
  const double load = 0x1p40;
  const NearestPointProblem problem{
      convex::Metric::identity(2), Vector{{-load, -load}}, convex::ConstraintRows(U), Vector{{1, 2, 0}}, {}};
  const convex::Solution solution = convex::active_set(problem);
  CHECK(solution.slack[2] == 3);
  CHECK(convex::tight_rows(problem, solution, tolerance) == std::vector<Index>{0, 1});
}

TEST_CASE("whether multipliers are unique is told by their signs, however far apart their sizes are") {
  // y >= 0 and 2y >= 0 share a force of 1 beside one of 2^34.
  RowMatrix U(3, 2);
  U << 1, 0, 0, 1, 0, 2;
  const double load = 0x1p34;
  const NearestPointProblem problem{
      convex::Metric::identity(2), Vector{{-load, -1}}, convex::ConstraintRows(U), Vector::Zero(3), {}};
  const Multipliers found = all_multipliers(problem);
  CHECK_FALSE(found.unique);
  REQUIRE(found.ranges.has_value());
  CHECK((*found.ranges)[0].low == load);
  CHECK((*found.ranges)[0].high == load);
  CHECK((*found.ranges)[1].low == 0);
  CHECK((*found.ranges)[1].high == doctest::Approx(1).epsilon(1e-12));
  CHECK((*found.ranges)[2].high == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("every method that solves tells the same multipliers where they are not unique") {
  // A body squeezed between two rows, and rows that share a load: ends of a method inside the dual optima.
  RowMatrix U(5, 3);
  U << -1, -1, 1, -2, 0, -2, 2, 0, 2, -0.5, -0.5, 0.5, 0, 1, 0;
  const NearestPointProblem problem{convex::Metric::diagonal(Vector::Constant(3, 4096)),
                                    Vector{{1, -4096, -1}},
                                    convex::ConstraintRows(U),
                                    Vector{{1, 1, -2, 0.5, -3}},
                                    {}};
  const double low[] = {0, 512, 0, 0, 0}, high[] = {2.0 / 3, 512, 0, 4.0 / 3, 0},
               least[] = {8.0 / 15, 512, 0, 4.0 / 15, 0};
  int solved = 0;
  for (const convex::Method& method : convex::methods()) {
    if (!method.applies(problem).empty()) continue;
    const convex::Solution solution = method.solve(problem, {});
    if (solution.status != convex::Status::solved) continue;
    CAPTURE(std::string(method.name));
    ++solved;
    const Multipliers found = convex::multipliers(problem, solution, tolerance, true);
    CHECK_FALSE(found.unique);
    REQUIRE(found.ranges.has_value());
    for (Index a = 0; a < 5; ++a) {
      CHECK((*found.ranges)[static_cast<std::size_t>(a)].low == doctest::Approx(low[a]).epsilon(1e-8));
      CHECK((*found.ranges)[static_cast<std::size_t>(a)].high == doctest::Approx(high[a]).epsilon(1e-8));
      CHECK(found.least_norm[a] == doctest::Approx(least[a]).epsilon(1e-8));
    }
  }
  CHECK(solved >= 8);
}

TEST_CASE("thousands of contacts through one point have multipliers of least norm") {
  // By the conditions of the shortest lambda >= 0 with Uᵀlambda = R: lambda = (Uy)⁺ for some y.
  constexpr Index n = 4, m = 1500;
  std::mt19937 generator(13);
  std::normal_distribution<double> normal;
  RowMatrix U(m, n);
  for (double& entry : U.reshaped()) entry = normal(generator);
  U.col(0) = U.col(0).cwiseAbs();
  const NearestPointProblem problem{convex::Metric::diagonal(Vector{{1, 2, 3, 4}}),
                                    Vector{{-9, 1, 2, -3}},
                                    convex::ConstraintRows(U),
                                    Vector::Zero(m),
                                    {0}};
  const Multipliers found = convex::multipliers(problem, convex::active_set(problem), tolerance, false);
  CHECK_FALSE(found.unique);
  const Vector& lambda = found.least_norm;
  CHECK((U.transpose() * lambda + problem.z).norm() <= 1e-13 * problem.z.norm());
  std::vector<Index> loaded;
  for (Index a = 0; a < m; ++a)
    if (a == 0 || lambda[a] != 0) loaded.push_back(a);
  const RowMatrix held = U(loaded, Eigen::all);
  const Vector of_held = lambda(loaded);
  const Vector y =
      convex::linear_algebra::Cholesky(held.transpose() * held).solve(held.transpose() * of_held);
  CHECK((held * y - of_held).norm() <= 1e-13 * of_held.norm());
  for (Index a = 1; a < m; ++a) {
    CHECK(lambda[a] >= 0);
    if (lambda[a] == 0) CHECK(U.row(a).dot(y) <= 1e-13 * of_held.norm());
  }
}

TEST_CASE("a row that opens by less than the tolerance takes no multiplier from those that hold") {
  // Masses 1e23 apart: q = (1, -3, -1), and c_3 opens by 1, which is 1e-12 of its scale.
  RowMatrix U(7, 3);
  U << 1, 0, -2, 3, 0, 0, -3, 0, 3, 0, 1, 2, 0, 2, 0, 1, 0, 0, 2, 0, 0;
  const NearestPointProblem problem{convex::Metric::diagonal(Vector{{1e10, 1, 1e-13}}),
                                    Vector{{6, -9, 6}},
                                    convex::ConstraintRows(U),
                                    Vector{{3, 3, -6, -6, -6, 0, 2}},
                                    {}};
  const convex::Solution found = convex::find_method("auto")->solve(problem, {});
  const Multipliers all = convex::multipliers(problem, found, tolerance, true);
  CHECK(all.least_norm[3] == 0);
  CHECK(all.least_norm[4] == doctest::Approx(3));
  CHECK((*all.ranges)[3].high == 0);
  CHECK((*all.ranges)[4].low == doctest::Approx(3));
}

TEST_CASE("multipliers beyond doubles are told as they are where rows depend on each other") {
  RowMatrix U(2, 1);
  U << 1, 2;
  const NearestPointProblem problem{
      convex::Metric::identity(1), Vector::Constant(1, -1), convex::ConstraintRows(U), Vector::Zero(2), {}};
  convex::Solution solution = convex::active_set(problem);
  solution.lambda[0] = std::numeric_limits<double>::infinity();
  const Multipliers found = convex::multipliers(problem, solution, tolerance, false);
  CHECK(std::isinf(found.least_norm[0]));
}

TEST_CASE(
    "rows independent by less than rounding, and short ones that others need, are known to be in doubt") {
  const auto found = [](const RowMatrix& U, const Vector& s, std::vector<Index> two_sided, const Vector& z) {
    return all_multipliers(
        {convex::Metric::identity(2), z, convex::ConstraintRows(U), s, std::move(two_sided)});
  };
  RowMatrix nearly_opposite(2, 2), copies(2, 2), short_one(3, 2);
  nearly_opposite << -1, -3, 1 + 24 * 0x1p-52, 3;
  CHECK(found(nearly_opposite, Eigen::Vector2d(-6, 6), {0, 1}, Eigen::Vector2d(0, 2)).is_in_doubt);
  copies << -1, -3, 1, 3;
  const Multipliers dependent = found(copies, Eigen::Vector2d(-6, 6), {0, 1}, Eigen::Vector2d(0, 2));
  CHECK_FALSE(dependent.is_in_doubt);
  CHECK_FALSE(dependent.unique);
  // u_0 = u_1 + u_2: the multipliers of u_0 and u_1 are anywhere in [0, 6], however short u_2 is.
  short_one << -1, -1, -1 - 32 * 0x1p-52, -1, 32 * 0x1p-52, 0;
  const Multipliers all =
      found(short_one, Eigen::Vector3d(5, 5 + 96 * 0x1p-52, -96 * 0x1p-52), {}, Eigen::Vector2d(3, 4));
  CHECK((all.is_in_doubt || !all.unique));
}
