#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"

using namespace convex;

TEST_CASE("vectors, radii and solutions that fit no problem are refused") {
  const Metric W = Metric::identity(3), D = Metric::diagonal(Vector{{1, 2}});
  CHECK_THROWS_AS(decompose(norm1(), Vector{{1, 2}}, W), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(W.multiply(Vector{{1, 2}})), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(D.solve(Vector{{1, 2, 3}})), InvalidInput);
  CHECK_THROWS_AS(Metric::identity(-1), InvalidInput);
  NearestPointProblem problem{
      D, Vector{{1, 1}}, ConstraintRows(RowMatrix{{1, 0}, {-1, 0}}), Vector{{1, 1}}, {}};
  const Solution none = automatic(problem);
  CHECK(none.status == Status::infeasible);
  CHECK_THROWS_AS(multipliers(problem, none, 1e-9, true), InvalidInput);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  for (const double radius : {-1.0, no_number}) {
    problem.radii = DataRadii{Vector{{0, radius}}, Vector{{0, 0}}};
    CHECK_THROWS_AS(static_cast<void>(automatic(problem)), InvalidInput);
  }
}
