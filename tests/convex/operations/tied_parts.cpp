#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Maxima of parts that the rounding of their values hardly tells apart: what is told solved is right.
using convex::Decomposition;
using convex::Metric;
using convex::Status;
using convex::Vector;
using samples::function;

TEST_CASE("where rounding hides which part of a maximum is the largest, the bound says so") {
  struct Case {
    const char* f;
    double z, x;
    bool is_known = false;
  };
  // x from the parts' slopes and the point where they are one, in forty digits of the doubles as read.
  for (const auto& [text, z, x, is_known] :
       {Case{"pointwise_max(sum(exponential(), constant(1e6)), sum(exponential(), linear([3e-5]), "
             "constant(999999.99997000015)))",
             3.718281828459045, 0.9999959729611873},
        {"pointwise_max(sum(exponential(), constant(1000)), sum(exponential(), linear([1e-6]), "
         "constant(999.9999990000001)))",
         3.718281828459045, 0.99999988378840503},
        {"inf_convolution(pointwise_max(exponential(), quadratic([[2]], [0], 1e6)), huber(1))", -1, -0.6},
        {"pointwise_max(exponential(), sum(exponential(), linear([0.5])))", 1, 0, true}}) {
    CAPTURE(text);
    const Decomposition split = convex::decompose(function(text, 1), Vector{{z}}, Metric::identity(1));
    CAPTURE(split.x.x[0]);
    const bool right = std::abs(split.x.x[0] - x) <= split.x.error_bound + 1e-15;
    CHECK((split.status != Status::solved || right));
    if (is_known) CHECK(split.status == Status::solved);
  }
}

TEST_CASE("parts of a piecewise linear-quadratic maximum that tie to rounding are told apart in fractions") {
  const Decomposition split = convex::decompose(
      function(
          "pointwise_max(sum(norm1(1), constant(1)), sum(norm1(1), linear([-3e-9]), constant(1.000000003)))",
          1),
      Vector{{2}}, Metric::identity(1));
  REQUIRE(split.status == Status::solved);
  CHECK(std::abs(split.x.x[0] - 1.000000003) <= 1e-15);
}

TEST_CASE("a maximum in a maximum is one of all parts") {
  std::string nested = "norm1()";
  for (int k = 0; k < 40; ++k)
    nested = "pointwise_max(" + nested + ", " + (k % 2 ? "norm1()" : "norm2()") + ")";
  const Decomposition split = convex::decompose(function(nested, 2), Vector{{3, 1}}, Metric::identity(2));
  REQUIRE(split.status == Status::solved);
  CHECK((split.x.x - Vector{{2, 0}}).norm() <= 1e-12);
}
