#include <doctest/doctest.h>

#include <string>

#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/sets.hpp"
#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::InvalidInput;
using convex::Matrix;
using convex::Metric;
using convex::Vector;

TEST_CASE("what is not convex, closed and proper, or does not fit, is refused at its place") {
  for (const char* text : {
           "scale(norm1(), 0)",
           "scale(norm1(), -1)",
           "scale(norm1(), inf)",
           "dilate(norm1(), 0)",
           "dilate(norm1(), inf)",
           "translate(norm1(), [1,2])",
           "translate(norm1(), [1,2,inf])",
           "tilt(norm1(), [1,2,3,4])",
           "envelope(norm1(), 0)",
           "envelope(norm1(), -2)",
           "proximal_average(norm1(), norm2(), 0, 1)",
           "proximal_average(norm1(), norm2(), 1, 1)",
           "proximal_average(norm1(), norm2(), 1.5, 1)",
           "proximal_average(norm1(), norm2(), 0.5, 0)",
           "sum(indicator(box(0, 1)), indicator(box(2, 3)))",
           "sum(indicator(simplex(1)), indicator(ball2(0.5)))",
           "sum(entropy(), indicator(box(-3, -1)))",
           "sum(norm1(), indicator(ball2()), indicator(halfspace([1,1,1], -2)))",
           "sum(logistic(), indicator(ball2()), indicator(ball2(1, [2,0,1])))",
           "sum()",
           "intersection(ball2(), halfspace([1,0,0], -1.5))",
           "intersection(orthant(), norm1())",
           "pointwise_max(indicator(box(0, 1)), indicator(box(2, 3)))",
           "pointwise_max()",
           "inf_convolution(linear([1,0,0]), linear([0,1,0]))",
           "inf_convolution(norm1(), linear([2,0,0]))",
           "inf_convolution(norm2(), linear([1,1,0]))",
           "inf_convolution(exponential(), linear([-1,0,0]))",
           "inf_convolution(hinge(), dilate(hinge(), -1), 3)",
           "inf_convolution(indicator(halfspace([1,0,0], 0)), linear([0,1,0]))",
           "precompose(norm1(), [[1,2],[3,4]])",
           "precompose(translate(norm1(), [1,2]), [[1,2,3]])",
           "precompose(norm1(), [[1,2,3]], [1,2])",
           "precompose(indicator(box(1, 2)), [[1,0,0],[-1,0,0]])",
           "precompose(log_barrier(), [[1,0,0],[-1,0,0]], [-1,-1])",
           "precompose(log_barrier(), [[0,0,0]], [-3])",
           "precompose(indicator(ball2(1)), [[0,0,0],[0,0,0]], [3,0])",
           "inf_convolution(dilate(negative_power(0.5), 2), exponential())",
           "inf_convolution(logistic(), negative_power(0.5))",
           "sum(inverse_power(1), indicator(box(-inf, 0)))",
           "sum(log_barrier(), dilate(entropy(), -1))",
           "separable(norm1(), 2)",
           "separable(norm1(), 2, norm1())",
           "separable(norm1(), 1.5, norm1(), 1.5)",
           "separable(norm1(), 0, norm1(), 3)",
           "separable(norm1(), norm1(), norm1(), 3)",
           "distance(norm1())",
           "distance(ball2(), 0)",
           "squared_distance(ball2(), -1)",
       }) {
    CAPTURE(text);
    try {
      samples::function(text, 3);
      FAIL_CHECK("it was taken");
    } catch (const InvalidInput& error) {
      CHECK(error.place());
      CHECK(std::string(error.what()).find("; ") != std::string::npos);
    }
  }
}

TEST_CASE("a convolution of one entry is improper where slopes meet at an open end alone") {
  // Of one entry max() is x, and the conjugate of the average is finite on [0, 1]; that of -sqrt(x) on v < 0.
  CHECK_THROWS_AS(
      samples::function("inf_convolution(proximal_average(norm2(1), max(), 0.5, 1), negative_power(0.5))", 1),
      InvalidInput);
  CHECK_NOTHROW(samples::function(
      "inf_convolution(proximal_average(norm2(1), norm1(1), 0.5, 1), negative_power(0.5))", 1));
}

TEST_CASE("sets that miss each other by the rounding of what was written are told how far they are apart") {
  // Of the doubles read 1/2 - 1/6 is above 1/3 by 2^-55, rounded to a double by 2^-54; and 3/4 - 1/4 is 1/2.
  try {
    samples::function("sum(hyperplane([1], 1/3), translate(ball1(1/6), [1/2]))", 1);
    FAIL_CHECK("it was taken");
  } catch (const InvalidInput& error) {
    CHECK(std::string(error.what()).find("miss each other by about 6e-17") != std::string::npos);
  }
  CHECK_NOTHROW(samples::function("sum(hyperplane([1], 1/2), translate(ball1(1/4), [3/4]))", 1));
  CHECK_NOTHROW(
      samples::function("sum(hyperplane([1], 0.33333333333333337), translate(ball1(1/6), [1/2]))", 1));
}

TEST_CASE("a domain that is empty, or beyond all numbers, is no gap of a length") {
  // log x at -1 whatever x is; a box moved beyond the largest double.
  for (const char* f : {"precompose(entropy(), [[1], [0]], [0, -1])",
                        "sum(translate(indicator(box(1e308, 1.5e308)), [1e308]), indicator(box(0, 1)))"})
    for (const char* whole : {f, "sum(%, box(0, 1))"}) {
      std::string text = whole;
      if (const std::size_t at = text.find('%'); at != std::string::npos) text.replace(at, 1, f);
      CAPTURE(text);
      try {
        samples::function(text, 1);
        FAIL_CHECK("it was taken");
      } catch (const InvalidInput& error) {
        CHECK(std::string(error.what()).find("miss each other") == std::string::npos);
        CHECK(std::string(error.what()).find("no point has all its functions finite") != std::string::npos);
      }
    }
}

TEST_CASE("what only looks improper is taken") {
  for (const char* text : {
           "sum(indicator(box(0, 1)), indicator(box(1, 2)))",
           "sum(indicator(simplex(1)), indicator(ball2(0.6)))",
           "sum(log_barrier(), indicator(halfspace([1,1,1], 1)))",
           "sum(norm1(), indicator(ball2()), indicator(halfspace([1,1,1], -1.7)))",
           "inf_convolution(norm1(), linear([1,-1,0.5]))",
           "inf_convolution(norm2(), linear([0.6,0.8,0]))",
           "inf_convolution(linear([1,2,3]), linear([1,2,3]))",
           "inf_convolution(indicator(halfspace([1,0,0], 0)), linear([2,0,0]))",
           "precompose(indicator(box(-1, 2)), [[1,0,0],[-1,0,0]])",
           "scale(norm1(), 1e-300)",
           "envelope(norm1(), 1e12)",
       }) {
    CAPTURE(text);
    CHECK_NOTHROW(samples::function(text, 3));
  }
}

TEST_CASE("a metric that couples the blocks is refused by what depends on it, and taken by the rest") {
  Matrix coupled = Matrix::Identity(3, 3), block = coupled;
  coupled(0, 2) = coupled(2, 0) = 0.5;
  block(0, 1) = block(1, 0) = 0.5;
  for (const char* part : {"envelope(norm1(), 1)", "conjugate(norm1())", "support(ball2())",
                           "scale(envelope(norm1(), 1), 2)", "proximal_average(norm1(), norm2(), 0.5, 1)"}) {
    const std::string text = std::string("separable(") + part + ", 2, norm1(), 1)";
    CAPTURE(text);
    CHECK_THROWS_AS(samples::function(text, Metric::dense(coupled)), InvalidInput);
    CHECK_NOTHROW(samples::function(text, Metric::dense(block)));
    CHECK_NOTHROW(
        samples::function("separable(precompose(" + std::string(part) + ", [[1,0],[0,1]]), 2, norm1(), 1)",
                          Metric::dense(coupled)));
  }
  CHECK_NOTHROW(samples::function("separable(norm2(), 2, norm1(), 1)", Metric::dense(coupled)));
}

TEST_CASE("inside separable the product is the block's, inside precompose the plain one") {
  Matrix W(3, 3);
  W << 2, 1, 0, 1, 3, 0, 0, 0, 5;
  const Metric product = Metric::dense(W);
  const auto f =
      samples::function("separable(envelope(norm1(), 0.5), 2, envelope(norm1(), 0.5), 1)", product);
  const auto first = convex::envelope(convex::norm1(), 0.5, Metric::dense(W.topLeftCorner(2, 2)));
  const auto last = convex::envelope(convex::norm1(), 0.5, Metric::diagonal(Vector::Constant(1, 5)));
  const auto g = samples::function("precompose(envelope(norm1(), 0.5), [[1,0,0],[0,1,0],[0,0,1]])", product);
  const auto plain = convex::envelope(convex::norm1(), 0.5);
  for (const Vector& x : samples::points(3)) {
    CHECK(f(x) == doctest::Approx(first(x.head(2)) + last(x.tail(1))).epsilon(1e-12));
    CHECK(g(x) == doctest::Approx(plain(x)).epsilon(1e-12));
  }
}

TEST_CASE("operations of one kind collapse, and those that do nothing vanish") {
  const auto text = [](const char* call) { return to_text(samples::function(call, 3).call()); };
  CHECK(text("translate(translate(norm1(), [1,2,3]), [1,0,-1])") == "translate(norm1(weight=1), by=[2,2,2])");
  CHECK(text("tilt(tilt(norm1(), [1,2,3]), [1,0,-1])") == "tilt(norm1(weight=1), c=[2,2,2])");
  CHECK(text("scale(scale(entropy(), 2), 3)") == "scale(entropy(), alpha=6)");
  CHECK(text("dilate(dilate(entropy(), 2), 3)") == "dilate(entropy(), rho=6)");
  CHECK(text("scale(scale(entropy(), 2), 0.5)") == text("entropy()"));
  CHECK(text("scale(indicator(ball2()), 7)") == text("indicator(ball2())"));
  CHECK(text("dilate(indicator(second_order_cone()), 7)") == text("indicator(second_order_cone())"));
  CHECK(text("conjugate(conjugate(sum(norm2(), hinge())))").find("conjugate") == std::string::npos);
}
