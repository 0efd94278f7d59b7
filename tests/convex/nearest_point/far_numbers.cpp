#include <doctest/doctest.h>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/repeated_problem.hpp"

/// Answers far below the pulls that rows hold, numbers whose errors have no squares, and calls that follow
/// others.
using namespace convex;

namespace {

/// (2, 1) 10^25 pulls at q_1 <= 1, -2 q_1 - 2 q_2 >= 1: the nearest point is (1, -3/2).
NearestPointProblem held_corner(double pull, Metric A = Metric::identity(2)) {
  return {
      std::move(A), pull * Vector{{2, 1}}, ConstraintRows(RowMatrix{{-1, 0}, {-2, -2}}), Vector{{-1, 1}}, {}};
}

NearestPointProblem of_size(double size) {
  return {Metric::dense(Matrix{{3, -1, 0.5}, {-1, 4, 0.25}, {0.5, 0.25, 2}}),
          size * Vector{{-1.1, 0.3, -0.7}},
          ConstraintRows(RowMatrix{{1, 0.3, 0}, {0, 1, 0.7}, {1, 1, 1}}),
          size * Vector{{0.1, 0.2, -3}},
          {}};
}

}  // namespace

TEST_CASE("a corner that holds a pull 1e30 times its size is told right, or not as solved") {
  for (const double pull : {1e10, 1e20, 1e25, -1e25, 1e30, -1e30}) {
    CAPTURE(pull);
    const bool is_dense = pull < 0;  // which solvers take, and leave, is not the same
    const NearestPointProblem problem =
        held_corner(std::abs(pull), is_dense ? Metric::dense(Matrix::Identity(2, 2)) : Metric::identity(2));
    RepeatedProblem repeated(problem);
    const Solution found[] = {automatic(problem), repeated.solve(problem.z, problem.s)};
    for (const Solution& each : found) {
      CHECK(each.status == Status::solved);
      CHECK((each.q - Vector{{1, -1.5}}).norm() <= std::min(each.error_bound, 1e-9));
      CHECK(each.acceleration_norm == doctest::Approx(std::sqrt(3.25)).epsilon(1e-9));
    }
    for (const Method& method : methods()) {
      CAPTURE(std::string(method.name));
      const Solution other = method.solve(problem, {});
      if (other.status == Status::solved) CHECK((other.q - Vector{{1, -1.5}}).norm() <= 1e-9);
    }
  }
}

TEST_CASE("the bound of an answer does not vanish with its square") {
  const Solution plain = automatic(of_size(1));
  REQUIRE(plain.error_bound > 0);
  for (const int exponent : {-470, -482, -700}) {
    CAPTURE(exponent);
    const double size = std::ldexp(1, exponent);
    const NearestPointProblem problem = of_size(size);
    RepeatedProblem repeated(problem);
    const Solution found[] = {automatic(problem), repeated.solve(problem.z, problem.s)};
    for (const Solution& each : found) {
      CHECK(each.status == Status::solved);
      CHECK(each.q == size * plain.q);
      CHECK(each.error_bound >= 0.25 * size * plain.rounding);
    }
  }
}

TEST_CASE("a witness belongs to the call that was infeasible") {
  NearestPointProblem problem = held_corner(1);
  problem.U = ConstraintRows(RowMatrix{{-1, 0}, {1, 0}});
  RepeatedProblem repeated(problem);
  CHECK(repeated.solve(problem.z, Vector{{-1, 2}}).status == Status::infeasible);
  const Solution& after = repeated.solve(problem.z, Vector{{-1, 0}});
  CHECK(after.status == Status::solved);
  CHECK(after.farkas.size() == 0);
}

TEST_CASE("every method answers a problem without rows") {
  const NearestPointProblem free{Metric::identity(3), Vector{{1, 2, 3}}, ConstraintRows(), Vector(0), {}};
  for (const Method& method : methods()) {
    if (!method.applies(free).empty()) continue;
    CAPTURE(std::string(method.name));
    const Solution found = method.solve(free, {});
    CHECK(found.status == Status::solved);
    CHECK((found.q - free.z).norm() <= 1e-9);
  }
}
