#include <doctest/doctest.h>

#include "convex/exact_program/exact_gram.hpp"
#include "convex/functions/decomposition.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/multipliers/sensitivity.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"
#include "convex/proved_prox/proved_split.hpp"
#include "convex/sets/subdifferential.hpp"

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

TEST_CASE("no metric measures or whitens a vector of another size") {
  const Vector x{{1, 2, 3}};
  for (const Metric& W :
       {Metric::identity(2), Metric::diagonal(Vector{{2, 1}}), Metric::dense(Matrix{{2, 1}, {1, 2}}),
        Metric::sparse(Matrix{{2, 1}, {1, 2}}.sparseView())}) {
    CHECK_THROWS_AS(static_cast<void>(W.norm(x)), InvalidInput);
    CHECK_THROWS_AS(static_cast<void>(W.dual_norm(x)), InvalidInput);
    CHECK_THROWS_AS(static_cast<void>(W.whiten(x)), InvalidInput);
    CHECK_THROWS_AS(static_cast<void>(W.unwhiten(x)), InvalidInput);
    CHECK_THROWS_AS(static_cast<void>(W.norm(x.head(1))), InvalidInput);
  }
}

TEST_CASE("what is asked in fractions of a point of another size is refused") {
  const Call f{"norm1"};
  const ExactGram W = exact_gram(Metric::identity(2));
  const Fractions two = fractions(Vector{{1, 0}}), three = fractions(Vector{{1, 0, 2}});
  CHECK_THROWS_AS(static_cast<void>(exact_split({f, three, W})), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(subdifferential(f, W, three)), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(prox_derivative(f, W, three, two)), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(prox_derivative(f, W, two, three)), InvalidInput);
  const Subdifferential at = subdifferential(f, W, two);
  CHECK_THROWS_AS(static_cast<void>(at.contains(three)), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(at.support(three)), InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(at.projection(Vector{{1, 2, 3}}, Metric::identity(3))), InvalidInput);
}

TEST_CASE("a change of bounds and weights of rows have a number for each row") {
  const NearestPointProblem problem{
      Metric::identity(2), Vector{{1, 1}}, ConstraintRows(RowMatrix{{1, 0}, {0, 1}}), Vector{{2, 0}}, {}};
  const Solution solution = automatic(problem);
  const Multipliers found = multipliers(problem, solution, 1e-9, false);
  const Vector dz{{1, 0}};
  CHECK_THROWS_AS(static_cast<void>(directional_derivative(problem, solution, found, dz, Vector{{1}})),
                  InvalidInput);
  CHECK_THROWS_AS(static_cast<void>(proves_infeasibility(problem, Vector{{1}}, 1)), InvalidInput);
}
