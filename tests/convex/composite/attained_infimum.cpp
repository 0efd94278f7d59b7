// Infima that are not attained: the functions that they are come out all the same.
#include <doctest/doctest.h>

#include "convex/composite/receding_directions.hpp"
#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Matrix;
using convex::Metric;
using convex::Status;
using convex::Vector;

TEST_CASE("an infimum that is reached nowhere but far out is 0, and its prox the point itself") {
  // u goes along (1,1,1,1), on which the distance stands still, and Σ u_i^(-1/2) to 0.
  for (const char* text : {"inf_convolution(inverse_power(0.5), distance(hyperplane([1,-1,3,-3], 0), 1))",
                           "inf_convolution(inverse_power(1), distance(box(-inf, 0), 1))",
                           "inf_convolution(indicator(hyperplane([1,-1,0,0], 0)), inverse_power(2))"}) {
    CAPTURE(std::string(text));
    const auto f = samples::function(text, 4);
    for (const Vector& z :
         {Vector{{1, 1.6675425165127766, 0.9468610708457135, 0.25}}, Vector{{-3, 2, -1e3, 0}}}) {
      const auto split = convex::decompose(f, z, Metric::identity(4));
      CHECK(split.status == Status::solved);
      CHECK((split.x.x - z).norm() <= 1e-12 * z.norm());
      CHECK(std::abs(f.evaluate(z).value) <= 1e-12);
    }
  }
}

TEST_CASE("entries that an infimum moves far out leave the function of the others") {
  // w_3 = 0 alone is asked of w: f(x) = 1 / x_3.
  const auto f = samples::function("inf_convolution(inverse_power(1), indicator(hyperplane([0,0,1], 0)))", 3);
  const auto third = samples::function("inverse_power(1)", 1);
  for (const double z3 : {2.0, 0.1, -4.0}) {
    CAPTURE(z3);
    const Vector z{{-1, 5, z3}};
    const Vector x = convex::decompose(f, z, Metric::identity(3)).x.x;
    const double truth = third.prox(z.tail(1), Metric::identity(1)).x[0];
    CHECK(std::abs(x[0] + 1) <= 1e-10);
    CHECK(std::abs(x[1] - 5) <= 1e-10);
    CHECK(std::abs(x[2] - truth) <= 1e-10);
  }
  CHECK(f.evaluate(Vector{{-1, 5, 2}}).value == doctest::Approx(0.5).epsilon(1e-10));
}

TEST_CASE("where a half-space leaves a sum of entries the point 0 alone, the split is that of 0") {
  const auto f = samples::function("sum(indicator(halfspace([1,3], 0)), entropy())", 2);
  const Vector z{{5.9906932192840365, 8.494209123805103}};
  Matrix gram(2, 2);
  gram << 9, -6, -6, 13;
  const auto split = convex::decompose(f, z, Metric::dense(gram));
  CHECK(split.status == Status::solved);
  CHECK(split.x.x.norm() <= 1e-9 * z.norm());
}

TEST_CASE("where quadratics hold all that is curved still, no program looks for a way far out") {
  for (const char* text :
       {"inf_convolution(pointwise_max(inverse_power(1), squared_norm2(2)), power(2))",
        "sum(inverse_power(1), inf_convolution(squared_norm2(1), pointwise_max(exponential(), "
        "huber(2))))"}) {
    CAPTURE(std::string(text));
    const auto form = samples::function(text, 2).node().graph(2, 1);
    REQUIRE(form);
    CHECK(convex::RecedingDirections(*form).entries().empty());
  }
}
