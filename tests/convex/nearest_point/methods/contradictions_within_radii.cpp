#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "convex/nearest_point/methods.hpp"
#include "convex/nearest_point/methods/crossover.hpp"

using convex::NearestPointProblem;
using convex::Status;
using convex::Vector;

namespace {

/// x, y and a heavy third coordinate; two equations of which the second is turned by 1e-4 from the first, and
/// between them a multiple of the second. They hold some 7e4 away, 3e4 times as far as z reaches.
NearestPointProblem nearly_parallel_rows_and_a_multiple(double bound_of_multiple) {
  const double pi = std::numbers::pi, slope = 1e-4, multiple = 1e3 * pi;
  const Eigen::RowVector3d first(pi, std::sqrt(2), 0.3);
  const Eigen::RowVector3d turned = first + slope * Eigen::RowVector3d(std::sqrt(2), std::cos(2), 0);
  convex::RowMatrix U(3, 3);
  U << first, multiple * turned, turned;
  NearestPointProblem problem{convex::Metric::diagonal(Eigen::Vector3d(1, 1, 1e6)),
                              Eigen::Vector3d(std::sqrt(7), std::cos(2), std::sqrt(7)),
                              convex::ConstraintRows(U),
                              Eigen::Vector3d(-2, multiple * bound_of_multiple, 2 * std::sqrt(7)),
                              {0, 2}};
  problem.radii = convex::rounding_radii(problem, 4);
  return problem;
}

}  // namespace

TEST_CASE(
    "a row and its multiple do not hide in their rounding that an equation beside them is another one") {
  const NearestPointProblem problem = nearly_parallel_rows_and_a_multiple(2 * std::sqrt(7));
  for (const convex::Method& method : convex::methods()) {
    if (!method.applies(problem).empty() || method.name == "exact") continue;
    CAPTURE(std::string(method.name));
    CHECK(method.solve(problem, {}).status != Status::infeasible);
  }
}

TEST_CASE("weights that combine rows to their rounding alone are judged by the rows, not by their sum") {
  const NearestPointProblem problem = nearly_parallel_rows_and_a_multiple(2 * std::sqrt(7));
  const Eigen::Vector3d seeming(-1, 124824608.59130849, -392148073336.67615);
  const convex::Solution found = convex::crossover(
      problem, {.method = "admm", .q = {}, .lambda = Vector::Zero(3), .farkas = seeming}, {});
  CHECK(found.status != Status::infeasible);
}

TEST_CASE("a multiple of a row with a larger bound contradicts it beyond their radii") {
  const NearestPointProblem problem = nearly_parallel_rows_and_a_multiple(2 * std::sqrt(7) + 1e-3);
  for (const convex::Method& method : convex::methods()) {
    if (!method.applies(problem).empty() || method.name == "exact" ||
        method.kind == convex::MethodKind::for_comparison)
      continue;
    CAPTURE(std::string(method.name));
    const convex::Solution found = method.solve(problem, {});
    CHECK(found.status == Status::infeasible);
    CHECK(found.farkas.size() == 3);
  }
}
