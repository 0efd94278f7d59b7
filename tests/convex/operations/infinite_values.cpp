#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// What is +inf, or nearly: told where it is proved.
using convex::Decomposition;
using convex::Metric;
using convex::Status;
using convex::Value;
using convex::Vector;
using samples::function;

TEST_CASE("a quadratic recedes where its matrix is 0, and not where it is small") {
  for (const char* small : {"1e-10", "1e-14", "1e-20", "1e-30"})
    for (const char* other : {"norm2()", "norm1()", "log_sum_exp()"}) {
      const std::string text =
          "pointwise_max(quadratic([[1,0],[0," + std::string(small) + "]], [0,0]), " + other + ")";
      CAPTURE(text);
      const Value found = function(text, 2).conjugate().evaluate(Vector{{0.5, 3}});
      CHECK((found.value < INFINITY || std::isinf(found.error)));
    }
  const Value large = function("pointwise_max(quadratic([[1,0],[0,1e-10]], [0,0]), norm2())", 2)
                          .conjugate()
                          .evaluate(Vector{{0.5, 3}});
  CHECK(large.value == doctest::Approx(4.5e10 + 0.125).epsilon(1e-12));
  // Of rank one, in directions that doubles do not hold.
  const Value flat = function("pointwise_max(quadratic([[1,3],[3,9]]), sum_largest(1))", 2)
                         .conjugate()
                         .evaluate(Vector{{3, -1}});
  CHECK(flat.value == INFINITY);
}

TEST_CASE("a perspective takes its function however small s is") {
  const Value found = function("epigraph(squared_norm2())", 2).conjugate().evaluate(Vector{{1, -1e-19}});
  CHECK(found.value == doctest::Approx(5e18).epsilon(1e-12));
}

TEST_CASE("the conjugate of a cone without interior is not 0 beside it") {
  for (const auto& [text, v] :
       {std::pair{"sum(indicator(second_order_cone()), indicator(hyperplane([1,0,-1], 0)))",
                  Vector{{0, 1, 0.01}}},
        {"intersection(power_cone(0.25), hyperplane([1,0,0], 0))", Vector{{0, 0.01, 1}}},
        {"log_sum_exp()", Vector{{0.5, 0.5000000005}}}}) {
    CAPTURE(text);
    const Value found = function(text, v.size()).conjugate().evaluate(v);
    CHECK((found.value == INFINITY || std::isinf(found.error)));
  }
}

TEST_CASE(
    "an inf-convolution of piecewise linear-quadratic functions is refused where fractions say that it is "
    "-inf") {
  const Decomposition split = convex::decompose(function("inf_convolution(indicator(halfspace([-2,0], -6)), "
                                                         "tilt(precompose(max(), [[1,-1]], [0]), [-1.5,1]))",
                                                         2),
                                                Vector{{2.96875, -4}}, Metric::identity(2));
  REQUIRE(split.status == Status::solved);
  CHECK(split.f_x == doctest::Approx(1.5 - 0.5 * split.x.x[0]).epsilon(1e-12));
  CHECK_THROWS_AS(function("inf_convolution(indicator(halfspace([-2,0], -6)), linear([1,1]))", 2),
                  convex::InvalidInput);
}

TEST_CASE(
    "a sum is +inf outside the domain of one of its functions, though another leaves the doubles there") {
  // Beside e^(200000) the ball of radius 0.000854 does not have 200.
  const Value found = function("inf_convolution(scale(entropy(),0.001),scale(norm2(0.854),0.001))", 1)
                          .conjugate()
                          .evaluate(Vector{{200}});
  CHECK(found.value == INFINITY);
  CHECK(found.error == 0);
}

TEST_CASE(
    "a sum over entries is +inf where one is off its domain, though another is near an edge for its size") {
  // g is the binary entropy: 1e12 is off [0, 1], whatever a point of that size makes of -300.
  for (const auto& [f, y] :
       {std::pair{"logistic()", Vector{{-300, 1e12}}}, {"exponential()", Vector{{-1e12, -30}}}}) {
    CAPTURE(std::string(f));
    const Value g = function(f, 2).conjugate().evaluate(y);
    CHECK(g.value == INFINITY);
    CHECK(g.error == 0);
  }
}

TEST_CASE("an envelope is finite where the prox is nearer than a rounding to the end of the domain") {
  // ½|v|² less what the root of 1e-20 is: at most 1e-20 sqrt(2|v|).
  const convex::Function g =
      function("sum(precompose(scale(negative_power(0.5), 1e-20), [[1,1]]), squared_norm2())", 2).conjugate();
  for (const Vector& v : {Vector{{1, 0.5}}, Vector{{1, 1}}, Vector{{-1, 1}}, Vector{{3, -1}}}) {
    const Value found = g.evaluate(v);
    CAPTURE(v.transpose());
    CHECK(std::abs(found.value - 0.5 * v.squaredNorm()) <= found.error + 1e-19);
  }
  const Value off =
      function(
          "sum(separable(inverse_power(0.5), 1, hinge(), 1), dilate(scale(max_affine("
          "[[3,-1.75],[3,-2.75]], [-64.4375,-77.4375]), 1.22e-10), 0.25), squared_norm2(9.54e11))",
          2)
          .conjugate()
          .evaluate(Vector{{3458249999999.9277, -3100500000001}});
  CHECK(std::abs(off.value - 11306390624998.2128) <= off.error);
  CHECK(off.error <= 1e-8 * off.value);
}
