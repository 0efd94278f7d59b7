#include "mechanics/exact_gauss_solution.hpp"

#include <doctest/doctest.h>

#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "convex/nearest_point/proof/exact_problem.hpp"
#include "mechanics/gauss_solution.hpp"

using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;

namespace {

/// A floor written twice, in numbers that are rounded: whether its rows depend on each other is open.
NearestPointProblem floor_written_twice() {
  NearestPointProblem problem{convex::Metric::identity(2),
                              Vector{{0.5, -1.0}},
                              convex::ConstraintRows(RowMatrix{{0.0, 1.0}, {0.0, 3.0}}),
                              Vector::Zero(2),
                              {}};
  problem.radii = convex::rounding_radii(problem, 1);
  return problem;
}

}  // namespace

TEST_CASE("what took fractions more than their limit they are not asked again") {
  const NearestPointProblem problem = floor_written_twice();
  const auto data = [&] { return std::optional(convex::exact_problem(problem)); };
  const mechanics::GaussOptions options;
  mechanics::GaussSolution found = mechanics::solve(problem, options), known = found;
  mechanics::decide_on_exact_data(found, problem, options, data);
  CHECK(found.as_written);
  known.was_too_long = true;
  mechanics::decide_on_exact_data(known, problem, options, data);
  CHECK_FALSE(known.as_written);
  CHECK(known.primal.undecided == convex::open_question::dependence);
}
