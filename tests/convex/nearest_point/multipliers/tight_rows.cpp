#include <doctest/doctest.h>

#include <cmath>

#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "convex/nearest_point/optimality/residuals.hpp"

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Vector;

namespace {

std::vector<Index> tight(const NearestPointProblem& problem) {
  return convex::tight_rows(problem, convex::automatic(problem, {}), 1e-9);
}

}  // namespace

TEST_CASE("a large acceleration closes no row that does not have it") {
  // q = (1e6, 0): the row q1 >= -0.001 is open by all of its terms, however light its coordinate is.
  for (const double mass : {1.0, 1e-6, 1e-12})
    CHECK(tight({Metric::diagonal(Vector{{1, mass}}),
                 Vector{{1e6, 0}},
                 convex::ConstraintRows(RowMatrix{{0, 1}}),
                 Vector{{-1e-3}},
                 {}})
              .empty());
}

TEST_CASE("a slack that is the difference of two rows of one direction is open, whatever presses on them") {
  // y >= 0 and y >= c at a light body under a weight that is rounded: c holds, and 0 is open by c.
  for (const double c : {2e-3, 2e-6, 2e-12}) {
    NearestPointProblem problem{Metric::diagonal(Vector{{1e-6}}),
                                Vector{{-9.864}},
                                convex::ConstraintRows(RowMatrix{{1}, {1}}),
                                Vector{{0, c}},
                                {}};
    problem.radii = convex::DataRadii{Vector::Zero(2), Vector::Zero(2)};
    CHECK(tight(problem) == std::vector<Index>{1});
  }
}

TEST_CASE("lengths of rows are known in all units") {
  for (const double unit : {1e-300, 1e-200, 1e-160, 1.0, 1e160, 1e300}) {
    CAPTURE(unit);
    const RowMatrix U = unit * RowMatrix{{3, 4}, {0, 0}};
    const Matrix A{{4, 0}, {0, 4}};
    for (const Metric& W : {Metric::identity(2).scaled(4), Metric::dense(A)}) {
      const NearestPointProblem dense{W, Vector::Zero(2), convex::ConstraintRows(U), Vector::Zero(2), {}};
      const NearestPointProblem sparse{W,
                                       Vector::Zero(2),
                                       convex::ConstraintRows(convex::SparseRows(U.sparseView(1, 0))),
                                       Vector::Zero(2),
                                       {}};
      for (const NearestPointProblem& problem : {dense, sparse}) {
        const Vector length = convex::dual_lengths(problem, {0, 1});
        CHECK(length[0] == doctest::Approx(2.5 * unit).epsilon(1e-14));
        CHECK(length[1] == 0);
      }
    }
  }
}
