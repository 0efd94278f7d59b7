#include "mechanics/hypothesis.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "mechanics/gauss_solution.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;

namespace {

/// A problem whose contacts have U A⁻¹ Uᵀ = M and free accelerations w: A = M⁻¹, U = I, z = A w.
NearestPointProblem with_delassus_matrix(const Matrix& M, const Vector& w) {
  Matrix A = M.inverse();
  A = (0.5 * (A + A.transpose())).eval();
  return {convex::Metric::dense(A),
          A * w,
          convex::ConstraintRows(RowMatrix::Identity(M.rows(), M.rows())),
          Vector::Zero(M.rows()),
          {}};
}

mechanics::GaussSolution two_contacts(double coupling, double w1, double w2) {
  Matrix M(2, 2);
  M << 1, coupling, coupling, 1;
  return mechanics::solve(with_delassus_matrix(M, Eigen::Vector2d(w1, w2)));
}

}  // namespace

TEST_CASE("Delassus: both multipliers negative, yet one contact stays") {
  const mechanics::GaussSolution found = two_contacts(-0.8, 0.92, -0.7);
  CHECK_FALSE(found.hypothesis.accepted);
  CHECK(found.hypothesis.drop_negative_is_right == std::optional<bool>(false));
  CHECK(found.hypothesis.two_sided.multipliers[0] == doctest::Approx(-1));
  CHECK(found.hypothesis.two_sided.multipliers[1] == doctest::Approx(-0.1));
  CHECK(found.multipliers.least_norm[0] == 0);
  CHECK(found.multipliers.least_norm[1] == doctest::Approx(0.7));
  CHECK(found.primal.slack[0] == doctest::Approx(0.36));
}

TEST_CASE("Delassus: one multiplier negative, yet both contacts open") {
  const mechanics::GaussSolution found = two_contacts(0.8, 1, 0.5);
  CHECK(found.hypothesis.drop_negative_is_right == std::optional<bool>(false));
  CHECK(found.hypothesis.negative == std::vector<Index>{0});
  CHECK(found.multipliers.least_norm.norm() == 0);
}

TEST_CASE(
    "of the contacts with negative multipliers at least one opens, and the rule is right when gradients are "
    "orthogonal") {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  int rejected = 0, wrong = 0;
  for (int trial = 0; trial < 300; ++trial) {
    CAPTURE(trial);
    const Index m = 2 + trial % 5;
    const bool orthogonal = trial % 3 == 0;
    Matrix B(m, m);
    Vector w(m);
    for (Index i = 0; i < B.size(); ++i) B.data()[i] = normal(generator);
    for (Index i = 0; i < m; ++i) w[i] = normal(generator);
    Matrix M = B * B.transpose() + 0.3 * Matrix::Identity(m, m);
    if (orthogonal) M = Vector(M.diagonal()).asDiagonal();
    const mechanics::GaussSolution found = mechanics::solve(with_delassus_matrix(M, w));
    REQUIRE(found.primal.status == convex::Status::solved);
    // Accepted if and only if all two-sided multipliers are >= 0, which here are unique.
    CHECK(found.hypothesis.accepted == (found.hypothesis.two_sided.multipliers.minCoeff() >= 0));
    if (found.hypothesis.accepted) continue;
    ++rejected;
    bool one_opens = false;
    for (Index a : found.hypothesis.negative) one_opens = one_opens || found.primal.slack[a] > 0;
    CHECK(one_opens);
    if (orthogonal) CHECK(*found.hypothesis.drop_negative_is_right);
    wrong += *found.hypothesis.drop_negative_is_right ? 0 : 1;
  }
  CHECK(rejected > 100);
  CHECK(wrong > 10);  // the sample would show nothing otherwise
}

TEST_CASE("the reaction from the dual alone is the one from the acceleration") {
  std::mt19937 generator(8);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    CAPTURE(trial);
    const Index n = 6, m = 4;
    Matrix B(n, n);
    RowMatrix U(m, n);
    Vector z(n), s(m);
    for (Index i = 0; i < B.size(); ++i) B.data()[i] = normal(generator);
    for (Index i = 0; i < U.size(); ++i) U.data()[i] = normal(generator);
    for (Index i = 0; i < n; ++i) z[i] = normal(generator);
    for (Index i = 0; i < m; ++i) s[i] = normal(generator);
    const mechanics::GaussSolution found =
        mechanics::solve({convex::Metric::dense(B * B.transpose() + Matrix::Identity(n, n)),
                          z,
                          convex::ConstraintRows(U),
                          s,
                          {}});
    REQUIRE(found.from_dual.has_value());
    CHECK(found.from_dual->difference <= 1e-13);
  }
}

TEST_CASE("a wrong acceleration shows in the reaction from the dual when every contact persists") {
  // Two contacts that press, independent: the two-sided motion is the true one.
  const NearestPointProblem problem =
      with_delassus_matrix(Matrix{{1, 0.2}, {0.2, 1}}, Eigen::Vector2d(-1, -2));
  const mechanics::GaussSolution right = mechanics::solve(problem);
  REQUIRE(right.primal.basis.size() == 2);
  REQUIRE(right.from_dual);
  CHECK(right.from_dual->difference <= 1e-14);
  convex::Solution wrong = right.primal;
  wrong.q = Eigen::Vector2d(0.7, -0.5);  // what forces >= 0 of the contacts would make
  const mechanics::Hypothesis judged = mechanics::hypothesis(problem, wrong, 1e-9);
  const auto found = mechanics::reaction_from_dual(problem, judged.two_sided, wrong);
  REQUIRE(found);
  CHECK(found->difference > 0.1);
  CHECK_FALSE(judged.accepted);
  // Also where the two-sided motion was read off the answer.
  const mechanics::TwoSided read_off{true, wrong.q, wrong.lambda, true, false};
  const auto again = mechanics::reaction_from_dual(problem, read_off, wrong);
  REQUIRE(again);
  CHECK(again->difference > 0.1);
}

TEST_CASE("what the error bound leaves open is no reason to reject the hypothesis of a body at rest") {
  // c: 2 x'' >= s_1 and -2 x'' = s_2 without forces, with what rounding leaves of s: either motion is rest.
  constexpr double u = 0x1p-53;
  NearestPointProblem problem{convex::Metric::identity(2),
                              Vector::Zero(2),
                              convex::ConstraintRows(RowMatrix{{2, 0.3}, {-1.4, -0.21}, {1, 1}}),
                              Vector{{0, 2 * u, 0}},
                              {1, 2},
                              convex::DataRadii{Vector::Constant(3, 8 * u), Vector::Constant(3, 8 * u)}};
  const mechanics::GaussSolution found = mechanics::solve(problem);
  REQUIRE(found.primal.status == convex::Status::solved);
  CHECK(found.primal.error_bound >= found.primal.acceleration_norm);
  CHECK(found.hypothesis.accepted);
}

TEST_CASE("a weight of 1 beside a press of 1e12 presses, and what lifts with 1 there opens") {
  const auto beside_press = [](double force) {
    const Matrix A{{1, 1e-3}, {1e-3, 1}};
    return mechanics::solve({convex::Metric::dense(A),
                             Vector{{-1e12, force}},
                             convex::ConstraintRows(RowMatrix::Identity(2, 2)),
                             Vector::Zero(2),
                             {}});
  };
  const mechanics::GaussSolution weight = beside_press(-1), none = beside_press(0), lift = beside_press(1);
  CHECK(weight.touching.empty());
  CHECK(weight.hypothesis.accepted);
  CHECK(none.touching == std::vector<Index>{1});
  CHECK(none.hypothesis.accepted);
  CHECK_FALSE(lift.hypothesis.accepted);
  CHECK(lift.hypothesis.negative == std::vector<Index>{1});
  CHECK(lift.hypothesis.drop_negative_is_right == std::optional<bool>(true));
}

TEST_CASE("what lifts with 1 opens beside a coordinate that moves with 1e12") {
  const Matrix A{{1, 0x1p-50}, {0x1p-50, 1}};
  const mechanics::GaussSolution flung = mechanics::solve({convex::Metric::dense(A),
                                                           Vector{{1e12, 1}},
                                                           convex::ConstraintRows(RowMatrix::Identity(2, 2)),
                                                           Vector::Zero(2),
                                                           {}});
  CHECK(flung.multipliers.tight.empty());
  CHECK(flung.touching.empty());
  CHECK(flung.hypothesis.negative == std::vector<Index>{0, 1});
}

TEST_CASE(
    "a hypothesis whose only multipliers have a negative one is rejected, however close the accelerations") {
  const NearestPointProblem problem{convex::Metric::dense(Matrix{{14, -7}, {-7, 6}}),
                                    Vector{{4, -6}},
                                    convex::ConstraintRows(RowMatrix{{2, -3}, {-3.9999999962747097, 6}}),
                                    Vector::Zero(2),
                                    {}};
  const mechanics::GaussSolution found = mechanics::solve(problem);
  REQUIRE(found.primal.status == convex::Status::solved);
  CHECK(found.hypothesis.two_sided.unique);
  CHECK(found.hypothesis.two_sided.multipliers[0] == doctest::Approx(-2));
  CHECK_FALSE(found.hypothesis.accepted);
}

TEST_CASE("where a contact opens beside a large motion its multiplier below 0 is named, however small") {
  const mechanics::GaussSolution found = mechanics::solve({convex::Metric::diagonal(Vector{{1, 1e-12}}),
                                                           Vector{{1e6, 0}},
                                                           convex::ConstraintRows(RowMatrix{{0, 1}}),
                                                           Vector{{-1e-3}},
                                                           {}});
  CHECK_FALSE(found.hypothesis.accepted);
  CHECK(found.hypothesis.negative == std::vector<Index>{0});
  CHECK(found.hypothesis.drop_negative_is_right == std::optional<bool>(true));
}

TEST_CASE("a row presses in any units") {
  for (const double unit : {1e-200, 1e-160, 1.0, 1e160}) {
    const mechanics::GaussSolution found =
        mechanics::solve({convex::Metric::identity(2),
                          Vector{{0.3, -1}},
                          convex::ConstraintRows(RowMatrix{{-1, 0}, {0, unit}}),
                          Vector::Zero(2),
                          {}});
    CHECK(found.touching.empty());
    CHECK(found.multipliers.least_norm[1] * unit == doctest::Approx(1));
  }
}

TEST_CASE(
    "contacts that are one within their radii agree as equations, however the system rests without them") {
  constexpr double off = 1e-12;
  const NearestPointProblem problem{convex::Metric::identity(1),
                                    Vector::Zero(1),
                                    convex::ConstraintRows(RowMatrix{{1}, {1 + off}, {2}}),
                                    Vector{{1, 1, 2}},
                                    {2},
                                    convex::DataRadii{Vector::Constant(3, off), Vector::Zero(3)}};
  const mechanics::GaussSolution found = mechanics::solve(problem);
  REQUIRE(found.primal.status == convex::Status::solved);
  CHECK(found.multipliers.tight.size() == 3);
  CHECK(found.hypothesis.two_sided.consistent);
  CHECK(found.hypothesis.accepted);
}
