#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Averages against what is known of them without a program (Bauschke, Goebel, Lucet and Wang 2008).
using convex::Decomposition;
using convex::Index;
using convex::Metric;
using convex::Status;
using convex::Value;
using convex::Vector;
using samples::function;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// f of no program alone, and points inside its domain.
struct Averaged {
  std::string f;
  std::vector<double> x;
};
const Averaged averaged[] = {
    {"logistic()", {3}},
    {"log_barrier()", {1e-6, 2, 5}},
    {"inverse_power(1)", {0.25}},
    {"kullback_leibler(2)", {3, 1e-8}},
    {"log_sum_exp()", {3, -1, 0.5, 2}},
    {"norm2(3)", {-1, 4}},
    {"sum(exponential(), norm2(0.5))", {1, -2, 3}},
    {"pointwise_max(inverse_power(1), squared_norm2(0.25))", {0.5}},
};

Vector vector(const std::vector<double>& x) {
  return Eigen::Map<const Vector>(x.data(), static_cast<Index>(x.size()));
}

}  // namespace

TEST_CASE("the average of a function with itself is the function, with its slopes") {
  for (const auto& [text, numbers] : averaged)
    for (const char* weights : {"0.5, 1", "0.25, 3", "0.75, 0.0009765625"}) {
      CAPTURE(text);
      CAPTURE(weights);
      const Vector x = vector(numbers);
      const auto f = function(text, x.size());
      const auto average =
          function("proximal_average(" + text + ", " + text + ", " + weights + ")", x.size());
      const Value value = average.evaluate(x);
      CHECK(std::abs(value.value - f(x)) <= 1e-13 * std::abs(f(x)) + value.error);
      CHECK(value.error <= 1e-11 * std::max(1.0, std::abs(f(x))));
      const auto v = average.subgradient(x), expected = f.subgradient(x);
      REQUIRE(v);
      REQUIRE(expected);
      CHECK((*v - *expected).norm() <= 1e-7 * std::max(1.0, expected->norm()));
    }
}

TEST_CASE("the average of a function and its conjugate is half the square") {
  for (const char* text :
       {"exponential()", "norm2(2)", "log_barrier()", "entropy()", "power(3)", "logistic()"})
    for (const Vector& x : samples::points(3)) {
      CAPTURE(text);
      const auto average =
          function(std::string("proximal_average(") + text + ", conjugate(" + text + "), 0.5, 1)", 3);
      CHECK(average(x) == doctest::Approx(x.squaredNorm() / 2).epsilon(1e-10));
    }
}

TEST_CASE("at an end of its domain an average has the values of its functions at theirs") {
  const Vector zero = Vector::Zero(1), half = Vector::Constant(1, 0.5);
  const auto value = [](const char* text, const Vector& x) { return function(text, 1).evaluate(x); };
  // p = 0 and q = 0, at which -2 sqrt(q) is 0 with an infinite slope.
  const Value at_point = value("proximal_average(indicator(point([0])), negative_power(0.5), 0.5, 1)", zero);
  CHECK(at_point.value == 0);
  CHECK(at_point.error <= 1e-15);
  // q = 0 is outside the domain of 1/q.
  const Value open = value("proximal_average(conjugate(exponential()), inverse_power(1), 0.5, 1)", zero);
  CHECK(open.value == infinity);
  CHECK(open.error == 0);
  // p = 1, q = 0: (1/4) |p - q|²/2 of the square, and log_barrier(0) = inf.
  const Value square = value("proximal_average(indicator(point([1])), indicator(box(0, inf)), 0.5, 1)", half);
  CHECK(square.value == doctest::Approx(0.125).epsilon(1e-15));
  const Value steep = value("proximal_average(indicator(point([1])), log_barrier(), 0.5, 1)", half);
  CHECK(steep.value == infinity);
  CHECK(steep.error == 0);
}

TEST_CASE("a maximum with an average that rises without end beside an open end of its domain is split") {
  struct Question {
    const char* f;
    double z;
  };
  for (const auto& [text, z] :
       {Question{"pointwise_max(proximal_average(conjugate(exponential()), sum(distance(point([1]), 1), "
                 "inverse_power(0.5)), 0.5, 1), translate(tilt(distance(ball_inf(3), 2), [1]), [-1]))",
                 -2.5230760254186446},
        Question{"pointwise_max(translate(power(2), [-1]), proximal_average(sum(kullback_leibler(2), "
                 "indicator(ball_inf(1024))), pointwise_max(inverse_power(1), squared_norm2(0.25)), 0.5, 1))",
                 -10},
        Question{"pointwise_max(binary_entropy(), pointwise_max(proximal_average(inverse_power(0.5), "
                 "inverse_power(0.5), 0.5, 1), inf_convolution(indicator(box(0, inf)), huber(1))))",
                 -2}}) {
    CAPTURE(text);
    const auto f = function(text, 1);
    const Vector at = Vector::Constant(1, z);
    const Decomposition split = convex::decompose(f, at, Metric::identity(1));
    CHECK(split.status == Status::solved);
    const Vector x = split.x.x;
    REQUIRE(x.size() == 1);
    // No point beside x is better, by values alone.
    const auto height = [&](double u) { return f(Vector::Constant(1, u)) + (u - z) * (u - z) / 2; };
    for (const double part : {1e-6, 1e-4, 1e-2})
      for (const double sign : {-1.0, 1.0}) CHECK(height(x[0] * (1 + sign * part)) >= height(x[0]));
  }
}
