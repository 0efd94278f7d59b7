#include <doctest/doctest.h>

#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"

using namespace convex;

TEST_CASE("the nearest point of a polyhedron, or the reason why there is none") {
  // Minimise ½ q·Aq - z·q over q_1 + q_2 >= 2 and q_1 - q_2 >= 0.
  const Metric A = Metric::diagonal(Vector{{1, 3}});
  const NearestPointProblem problem{
      A, Vector{{0, 0}}, ConstraintRows(RowMatrix{{1, 1}, {1, -1}}), Vector{{2, 0}}, {}};
  validate(problem);
  const Solution solution = methods().front().solve(problem, Accuracy{});
  CHECK(solution.status == Status::solved);
  CHECK(solution.q.isApprox(Vector{{1.5, 0.5}}, 1e-15));
  CHECK(solution.lambda.isApprox(Vector{{1.5, 0}}, 1e-15));  // Aq = z + Uᵀlambda, lambda >= 0
  CHECK(solution.slack.isApprox(Vector{{0, 1}}, 1e-15));
  CHECK(solution.error_bound <= 1e-15);

  // q_1 + q_2 >= 2, -q_1 >= 0 and -q_2 >= 1 exclude each other: their sum reads 0 >= 3.
  const NearestPointProblem impossible{
      A, Vector{{0, 0}}, ConstraintRows(RowMatrix{{1, 1}, {-1, 0}, {0, -1}}), Vector{{2, 0, 1}}, {}};
  const Solution none = methods().front().solve(impossible, Accuracy{});
  CHECK(none.status == Status::infeasible);
  CHECK((impossible.U.transpose_times(none.farkas)).norm() <= 1e-15 * none.farkas.norm());
  CHECK(none.farkas.minCoeff() > 0);
  CHECK(none.farkas.dot(impossible.s) > 0);
  CHECK(proves_infeasibility(impossible, none.farkas, 1e6));  // for all q with ||q||_A up to a million
}
