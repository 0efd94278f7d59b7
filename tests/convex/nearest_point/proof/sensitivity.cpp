#include "convex/nearest_point/multipliers/sensitivity.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"
#include "tests/oracles/full_mantissa.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::Index;
using convex::Multipliers;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Vector;
using oracles::Difficulty;

namespace {

/// So small a step that integer problems do not change their active rows within it.
constexpr double step = 0x1p-36;

/// (q(step) - q(0)) / step in fractions.
Vector exact_quotient(const NearestPointProblem& problem, const Vector& dz, const Vector& ds) {
  NearestPointProblem moved = problem;
  moved.z += step * dz;
  moved.s += step * ds;
  const auto now = oracles::rationals(convex::exact_active_set(convex::exact_problem(problem), {}).q);
  const auto then = oracles::rationals(convex::exact_active_set(convex::exact_problem(moved), {}).q);
  Vector quotient(dz.size());
  for (Index i = 0; i < dz.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    quotient[i] = oracles::Rational((then[k] - now[k]) / oracles::Rational(step)).get_d();
  }
  return quotient;
}

Vector integers(unsigned seed, Index n) {
  std::mt19937 generator(seed);
  Vector x(n);
  for (Index i = 0; i < n; ++i) x[i] = std::uniform_int_distribution<int>(-3, 3)(generator);
  return x;
}

}  // namespace

TEST_CASE(
    "the derivative along a change of forces or bounds is the difference quotient, weak contacts and "
    "multipliers that are not unique included") {
  int chosen = 0;  // problems in which ds chooses among multipliers
  for (const Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::two_sided_rows, Difficulty::at_rest})
    for (unsigned seed = 0; seed < 25; ++seed) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const NearestPointProblem problem = oracles::planted_problem(seed, 4, 6, difficulty).problem;
      const Solution solution = convex::active_set(problem);
      const Multipliers all = convex::multipliers(problem, solution, 1e-9, false);
      const Vector dz = integers(seed, 4), still = Vector::Zero(6);
      const auto by_force = convex::directional_derivative(problem, solution, all, dz, still);
      REQUIRE(by_force);
      CHECK((by_force->acceleration - exact_quotient(problem, dz, still)).norm() <= 1e-9);
      // R = A q - z.
      CHECK((by_force->reaction - (problem.A.multiply(by_force->acceleration) - dz)).norm() <= 1e-9);
      const Vector ds = integers(seed + 100, 6);
      const auto by_bound = convex::directional_derivative(problem, solution, all, dz, ds);
      if (by_bound) {
        CHECK((by_bound->acceleration - exact_quotient(problem, dz, ds)).norm() <= 1e-8);
        chosen += !all.unique;
      } else {  // only where no motion keeps the rows
        NearestPointProblem moved = problem;
        moved.s += step * ds;
        CHECK(convex::exact_active_set(convex::exact_problem(moved), {}).status ==
              convex::Status::infeasible);
      }
    }
  CHECK(chosen > 10);
}

TEST_CASE(
    "of two contacts that say the same, the one that is raised carries, and one lowered changes nothing") {
  // q >= 0 twice, pressed by z = -2: multipliers (1, 1) are of least norm, and (2, 0) carries when the first
  // floor rises.
  const NearestPointProblem floors{convex::Metric::diagonal(Vector{{1.0}}),
                                   Vector{{-2.0}},
                                   convex::ConstraintRows(RowMatrix{{1.0}, {1.0}}),
                                   Vector{{0.0, 0.0}},
                                   {}};
  const Solution resting = convex::active_set(floors);
  const Multipliers all = convex::multipliers(floors, resting, 1e-9, false);
  REQUIRE_FALSE(all.unique);
  const auto along = [&](double first, double second) {
    const auto found =
        convex::directional_derivative(floors, resting, all, Vector::Zero(1), Vector{{first, second}});
    REQUIRE(found);
    return found->acceleration[0];
  };
  CHECK(along(1, 0) == doctest::Approx(1));
  CHECK(along(-1, 0) == doctest::Approx(0));
  CHECK(along(1, 3) == doctest::Approx(3));
  CHECK(along(-1, -3) == doctest::Approx(-1));
}

TEST_CASE(
    "derivatives by bounds do not hang on the units of rows, multipliers that are not unique included") {
  const Vector unit{{1, 0x1p30, 0x1p100, 0x1p-30, 0x1p100, 1}};
  int chosen = 0;
  for (const Difficulty difficulty : {Difficulty::repeated_rows, Difficulty::two_sided_rows})
    for (unsigned seed = 0; seed < 25; ++seed) {
      CAPTURE(seed);
      const NearestPointProblem plain = oracles::planted_problem(seed, 4, 6, difficulty).problem;
      const RowMatrix U = unit.asDiagonal() * plain.U.dense();
      const NearestPointProblem scaled{plain.A, plain.z, convex::ConstraintRows(U),
                                       unit.cwiseProduct(plain.s), plain.two_sided};
      const Vector still = Vector::Zero(4), ds = integers(seed + 100, 6);
      const auto along = [&](const NearestPointProblem& problem, const Vector& change) {
        const Solution solution = convex::active_set(problem);
        const Multipliers all = convex::multipliers(problem, solution, 1e-9, false);
        chosen += !all.unique;
        return convex::directional_derivative(problem, solution, all, still, change);
      };
      const auto by_plain = along(plain, ds), by_scaled = along(scaled, unit.cwiseProduct(ds));
      REQUIRE(by_plain.has_value() == by_scaled.has_value());
      if (by_plain) CHECK((by_plain->acceleration - by_scaled->acceleration).norm() <= 1e-8);
    }
  CHECK(chosen > 20);
}

TEST_CASE("multipliers that are unique and do not stay so have no derivative") {
  // R = (1, 0) is the push of the first row alone; (1, t) is one of the first with either of the others.
  const NearestPointProblem corner{convex::Metric::identity(2),
                                   Vector{{-1.0, 0.0}},
                                   convex::ConstraintRows(RowMatrix{{1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}),
                                   Vector::Zero(3),
                                   {}};
  const Solution resting = convex::active_set(corner);
  const Multipliers all = convex::multipliers(corner, resting, 1e-9, false);
  REQUIRE(all.unique);
  const auto along = [&](const Vector& dz) {
    return *convex::directional_derivative(corner, resting, all, dz, Vector::Zero(3));
  };
  CHECK_FALSE(along(Vector{{0.0, -1.0}}).multipliers);
  CHECK(along(Vector{{0.0, -1.0}}).reaction == Vector{{0.0, 1.0}});
  REQUIRE(along(Vector{{-1.0, 0.0}}).multipliers);
  CHECK(*along(Vector{{-1.0, 0.0}}).multipliers == Vector{{1.0, 0.0, 0.0}});
}

TEST_CASE("forces below the least margin change no contact, and a ball leaves its floor at its weight") {
  // m = 4, z = -40: the contact opens at a force 40 upwards, whose norm is 40 / sqrt(4).
  const NearestPointProblem ball{convex::Metric::diagonal(Vector{{4.0}}),
                                 Vector{{-40.0}},
                                 convex::ConstraintRows(RowMatrix{{1.0}, {-1.0}}),
                                 Vector{{0.0, -6.0}},
                                 {}};
  const Solution resting = convex::active_set(ball);
  const auto of_ball = convex::margins(ball, resting, convex::multipliers(ball, resting, 1e-9, false));
  REQUIRE(of_ball);
  CHECK((*of_ball)[0] == doctest::Approx(20));
  CHECK(std::isinf((*of_ball)[1]));  // with the floor held, no force moves the ball to the ceiling

  for (unsigned seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = oracles::full_mantissa(seed, 5, 8);
    const Solution solution = convex::active_set(problem);
    const Multipliers all = convex::multipliers(problem, solution, 1e-9, false);
    const auto margins = convex::margins(problem, solution, all);
    REQUIRE(margins);
    const double least = margins->minCoeff();
    std::vector<Index> held = solution.basis;
    std::sort(held.begin(), held.end());
    for (unsigned direction = 0; direction < 10; ++direction) {
      NearestPointProblem moved = problem;
      Vector dz = integers(direction, 5) + Vector::Constant(5, 0.5);
      moved.z += dz * (0.999 * least / problem.A.dual_norm(dz));
      std::vector<Index> then = convex::active_set(moved).basis;
      std::sort(then.begin(), then.end());
      CHECK(then == held);
    }
  }
}

TEST_CASE("a contact that carries 1e-13 beside one that carries 1 is held; one told as weak is not") {
  const NearestPointProblem floors{convex::Metric::identity(2),
                                   Vector{{-1.0, -1e-13}},
                                   convex::ConstraintRows(RowMatrix{{1.0, 0.0}, {0.0, 1.0}}),
                                   Vector::Zero(2),
                                   {}};
  const Solution resting = convex::active_set(floors);
  const Multipliers all = convex::multipliers(floors, resting, 1e-9, false);
  const auto lifted = [&](const std::vector<Index>& weak) {
    return convex::directional_derivative(floors, resting, all, Vector{{0.0, 1.0}}, Vector::Zero(2), weak)
        ->acceleration;
  };
  CHECK(lifted({}) == Vector::Zero(2));
  CHECK(lifted({1}) == Vector{{0.0, 1.0}});
  CHECK(convex::margins(floors, resting, all) == Vector{{1.0, 1e-13}});
}

TEST_CASE("margins and derivatives do not hang on the method that found the point") {
  int compared = 0;
  for (const Difficulty difficulty : {Difficulty::none, Difficulty::repeated_rows, Difficulty::at_rest})
    for (unsigned seed = 0; seed < 12; ++seed) {
      const NearestPointProblem problem = oracles::planted_problem(seed, 4, 6, difficulty).problem;
      const Solution usual = convex::active_set(problem);
      const Multipliers known = convex::multipliers(problem, usual, 1e-9, false);
      const Vector dz = integers(seed + 100, 4), ds = Vector::Zero(6);
      const auto margins = convex::margins(problem, usual, known);
      const auto moved = convex::directional_derivative(problem, usual, known, dz, ds);
      for (const convex::Method& method : convex::methods()) {
        if (!method.applies(problem).empty()) continue;
        const Solution other = method.solve(problem, {});
        if (other.status != convex::Status::solved) continue;
        CAPTURE(seed);
        CAPTURE(std::string(method.name));
        const Multipliers found = convex::multipliers(problem, other, 1e-9, false);
        REQUIRE(found.unique == known.unique);
        const auto their_margins = convex::margins(problem, other, found);
        REQUIRE(their_margins.has_value() == margins.has_value());
        for (Index a = 0; margins && a < 6; ++a)
          CHECK(std::min((*their_margins)[a], 1e9) ==
                doctest::Approx(std::min((*margins)[a], 1e9)).epsilon(1e-6));
        const auto theirs = convex::directional_derivative(problem, other, found, dz, ds);
        REQUIRE(theirs.has_value() == moved.has_value());
        if (moved)
          CHECK((theirs->acceleration - moved->acceleration).norm() <=
                1e-8 * (1 + moved->acceleration.norm()));
        ++compared;
      }
    }
  CHECK(compared > 200);
}
