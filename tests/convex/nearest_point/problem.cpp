#include "convex/nearest_point/problem.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"

using convex::RowMatrix;
using convex::Vector;

namespace {

convex::NearestPointProblem two_by_two() {
  return {convex::Metric::identity(2),
          Vector::Zero(2),
          convex::ConstraintRows(RowMatrix::Identity(2, 2)),
          Vector::Zero(2),
          {}};
}

void refuses(const convex::NearestPointProblem& problem, const char* name) {
  CAPTURE(name);
  CHECK_THROWS_WITH_AS(convex::active_set(problem), doctest::Contains(name), convex::InvalidInput);
}

}  // namespace

TEST_CASE("data that do not fit together, or are not finite, are refused at the door by name") {
  CHECK_NOTHROW(convex::active_set(two_by_two()));
  auto problem = two_by_two();
  problem.z = Vector::Zero(3);
  refuses(problem, "z: 3 entries");
  problem = two_by_two();
  problem.s = Vector::Zero(1);
  refuses(problem, "s: 1 entry");
  problem = two_by_two();
  problem.U = convex::ConstraintRows(RowMatrix::Identity(2, 3));
  refuses(problem, "U: rows of 3");
  problem = two_by_two();
  RowMatrix U = RowMatrix::Identity(2, 2);
  U(1, 0) = std::numeric_limits<double>::quiet_NaN();
  for (const bool sparse : {false, true}) {
    problem.U =
        sparse ? convex::ConstraintRows(convex::SparseRows(U.sparseView())) : convex::ConstraintRows(U);
    refuses(problem, "U: row 1");
  }
  problem = two_by_two();
  problem.s[1] = std::numeric_limits<double>::infinity();
  refuses(problem, "s[1]");
  problem = two_by_two();
  problem.two_sided = {2};
  refuses(problem, "no row 2");
  problem.two_sided = {1, 0};
  refuses(problem, "two_sided");
}
