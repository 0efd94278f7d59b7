#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Numbers of nested operations that cancel but for what is left of them.
using convex::Decomposition;
using convex::Index;
using convex::Metric;
using convex::Status;
using convex::Value;
using convex::Vector;
using samples::function;

namespace {

/// The root of x + slope + e^x, by Newton's method.
double root_with_exponential(double slope) {
  double x = -0.5;
  for (int k = 0; k < 50; ++k) x -= (x + slope + std::exp(x)) / (1 + std::exp(x));
  return x;
}

}  // namespace

TEST_CASE("shifts and slopes that cancel in nested operations leave what is left of them") {
  struct Case {
    const char* f;
    Index n;
    Vector x;
  };
  for (const auto& [text, n, x] :
       {Case{"translate(translate(translate(norm1(), 1), 1e20), -1e20)", 1, Vector{{1}}},
        {"translate(translate(translate(logistic(), 1e20), 1), -1e20)", 1, Vector{{}}},
        {"tilt(tilt(tilt(exponential(), 1), 1e20), -1e20)", 1, Vector{{root_with_exponential(1)}}},
        {"sum(exponential(), linear([1e-3]), linear([1e10]), linear([-1e10]))", 1,
         Vector{{root_with_exponential(1e-3)}}},
        {"sum(norm1(), linear([0.5]), linear([1e16]), linear([-1e16]))", 1, Vector{{0}}},
        {"precompose(precompose(exponential(), [[1,1,1]]), [[1e20],[1],[-1e20]])", 1,
         Vector{{root_with_exponential(0)}}}}) {
    CAPTURE(text);
    const Decomposition split = convex::decompose(function(text, n), Vector::Zero(n), Metric::identity(n));
    if (x.size() > 0) {
      REQUIRE(split.status == Status::solved);
      CHECK((split.x.x - x).norm() <= split.x.error_bound + 4e-16);
    } else {
      const Decomposition plain =
          convex::decompose(function("translate(logistic(), 1)", n), Vector::Zero(n), Metric::identity(n));
      CHECK((split.x.x - plain.x.x).norm() <= split.x.error_bound + plain.x.error_bound);
    }
  }
}

TEST_CASE("the conjugate of a map counts what its inverse is rounded by") {
  struct Case {
    const char* f;
    Vector v;
    double value;
  };
  // v = Aᵀ(Ax + b) exactly, value = x·v - f(x) in fractions, rounded.
  for (const auto& [text, v, value] :
       {Case{"precompose(squared_norm2(), [[1,-1,3],[3,3,-2],[0.9999990463256836,-0.9999990463256836,"
             "2.9999990463256836]], [1,0,0])",
             Vector{{-23.99999427795501, -6.000005722044989, -16.99999237060638}}, 36.9999952316288727},
        {"precompose(squared_norm2(), [[-1,-3],[-1.0000009536743164,-3]], [2,-2])",
         Vector{{-6.000003814699994, -18.000008583068848}}, 5.00000858307294},
        {"precompose(pinball(0), [[0,-2,0,-2],[0,-3,3,-3],[3,-3,1,-3]], [4,5,0])", Vector{{-3, 3, -1, 3}}, 0},
        {"precompose(sum_largest(1), [[-3,-2],[-2,-1]], [1,-1])", Vector{{-3, -2}}, -1}}) {
    CAPTURE(text);
    const Value found = function(text, v.size()).conjugate().evaluate(v);
    CHECK(std::abs(found.value - value) <= found.error + 4e-15 * std::abs(value));
    CHECK(found.error <= 1e-12 * (1 + std::abs(value)));
  }
}

TEST_CASE("a square that overflows hides no point outside a domain") {
  for (const char* text : {"tilt(norm1(), 1)", "tilt(hinge(), 1)", "sum(norm1(), linear([1]))",
                           "precompose(norm1(), [[2]], [1])", "tilt(log_barrier(), 1)"}) {
    CAPTURE(text);
    const Value found = function(text, 1).conjugate().evaluate(Vector{{1e160}});
    CHECK((std::isinf(found.value) || std::isinf(found.error)));
  }
}

TEST_CASE("a constant beside entries whose slopes are pinned stays") {
  CHECK(function("inf_convolution(sum(entropy(), constant(5)), hyperplane([1,0], 0))", 2)
            .conjugate()
            .evaluate(Vector{{1, 0}})
            .value == doctest::Approx(1 + std::exp(-1.0) - 5).epsilon(1e-14));
  const Decomposition split = convex::decompose(
      function("inf_convolution(sum(power(1.5), constant(5)), precompose(huber(), [[0,3]], [4]))", 2),
      Vector{{1, 2}}, Metric::identity(2));
  const Decomposition outside = convex::decompose(
      function("sum(inf_convolution(power(1.5), precompose(huber(), [[0,3]], [4])), constant(5))", 2),
      Vector{{1, 2}}, Metric::identity(2));
  CHECK(split.f_x == doctest::Approx(outside.f_x).epsilon(1e-12));
  CHECK((split.x.x - outside.x.x).norm() <= 1e-12);
}

TEST_CASE("the conjugate of functions of groups has all of their sum") {
  const auto f = function("sum(group_norm(3, 3), squared_hinge(), indicator(ball_inf(1000)))", 3);
  const Vector y{{30, 40, -2}};
  CHECK(f.conjugate().conjugate().evaluate(y).value == doctest::Approx(f.evaluate(y).value).epsilon(1e-9));
}

TEST_CASE("the value near an edge that nested operations make is of their numbers, not of a rounded sum") {
  // Conjugates and functions whose argument is a small difference of shifts (sums, products and quotients of
  // doubles that are none); by forty digits.
  struct Case {
    const char* f;
    double at, value;
  };
  for (const auto& [text, at, value] :
       {Case{"tilt(tilt(log_barrier(),0.1),0.2)", 0.29999999999, 24.328433164640654888},
        {"conjugate(translate(translate(log_barrier(),0.1),0.2))", 0.3000000000001, 29.933572820048898786},
        {"conjugate(dilate(translate(dilate(translate(log_barrier(),-1.0),-1.06e-06),-2.0),-0.454))",
         0.9079995187600001, 23.235289395822160758},
        {"conjugate(translate(translate(log_barrier(),-1e-17),0.2))", 0.2, 39.143946580898776557},
        {"dilate(entropy(),539)", 1, 4.4712737906735932971e233}}) {
    CAPTURE(std::string(text));
    const Value found = function(text, 1).conjugate().evaluate(Vector::Constant(1, at));
    CHECK(std::abs(found.value - value) <= 1e-15 * std::abs(value));
    CHECK(std::abs(found.value - value) <= found.error);
    CHECK(found.error <= 1e-14 * std::abs(value));
  }
}
