#include "mechanics/gauss_function.hpp"

#include <doctest/doctest.h>

#include "convex/catalogue/catalogue.hpp"
#include "mechanics/gauss_solution.hpp"

using namespace mechanics;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Vector;

TEST_CASE(
    "the acceleration makes Gauss' function least among those that the contacts allow, by the function's own "
    "values") {
  Matrix A(3, 3), U(2, 3);
  A << 2, 1, 0, 1, 2, 0, 0, 0, 1;
  U << 0, 1, 0, 1, 1, 1;
  Vector z(3), s(2);
  z << 1, -3, -9.81;
  s << 0.5, -1;
  for (const std::vector<Index>& two_sided : {std::vector<Index>{}, {1}, {0, 1}}) {
    const convex::NearestPointProblem problem{Metric::dense(A), z, convex::ConstraintRows(U), s, two_sided};
    const GaussSolution solution = solve(problem);
    const convex::Function G = gauss_function(problem), allowed = allowed_accelerations(problem).indicator;
    const Vector q = solution.primal.q;
    CHECK(G(q) == doctest::Approx(solution.gauss).epsilon(1e-13));
    CHECK(allowed(q) == 0);
    CHECK(appell_function(problem, 7)(q) == doctest::Approx(solution.gauss + 7).epsilon(1e-13));
    // prox_f(q + v) = q for f = G + the indicator and v = 0: q is stationary.
    for (Index i = 0; i < 3; ++i) {
      const Vector other = allowed.prox(q + 0.1 * Vector::Unit(3, i), Metric::identity(3)).x;
      CHECK(G(other) >= G(q) - 1e-12);
    }
  }
}

TEST_CASE("where all of a force of 1e26 is held the acceleration is 0 to the tolerance of small ones") {
  const convex::NearestPointProblem problem{
      Metric::dense(Matrix{{1.248870081195348e-14, 0}, {0, 5.824341794441237e-33}}),
      Vector{{-2.5455156593127883e+19, -2095551795.2712057}},
      convex::ConstraintRows(convex::RowMatrix{{5.7110245855953785, 0},
                                               {7.20744871959624e-08, -4.9750996257240654e-15},
                                               {706913427.1243902, 0.10914406038872114},
                                               {0, 0},
                                               {-1.0420913922923458e-18, 4.120042529510613e-28}}),
      Vector{{0, -4.369816708902907e+28, 0, -1.858136249501632e+20, 0}},
      {}};
  const GaussSolution found = solve(problem);
  CHECK(found.primal.status == convex::Status::solved);
  CHECK(found.primal.q.isZero(0));
  CHECK(found.primal.error_bound <= 1e-9);
}
