#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "convex/functions/norms.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/quadratic.hpp"
#include "convex/functions/separable_functions.hpp"
#include "convex/functions/sets.hpp"
#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

/// x log x at a point next to 1 is x log1p(x - 1): of the value itself the rounding of the point, where an
/// operation makes it, leaves no digit.
using namespace convex;

namespace {

/// (1 + t) log(1 + t).
double entropy_above_one(double t) { return (1 + t) * std::log1p(t); }

void check_near(const Value& found, double truth) {
  CHECK(std::abs(found.value - truth) <= 16 * unit_roundoff * std::abs(truth));
  CHECK(std::abs(found.value - truth) <= found.error);
  CHECK(found.error <= 64 * unit_roundoff * std::abs(truth));
}

}  // namespace

TEST_CASE("where a function cancels, operations tell its value to roundings of the value") {
  SUBCASE("a perspective, whose quotient is rounded") {
    for (const double s : {3.0, 1e8 + 1, 3e12 + 1}) {
      const double x = s - 0.375;
      check_near(perspective(entropy()).evaluate(Vector{{x, s}}), s * entropy_above_one(-0.375 / s));
    }
  }
  SUBCASE("a translate, whose difference is rounded") {
    for (const double t : {1e-12, -3e-17, 1e-30})
      check_near(translate(entropy(), Vector::Constant(1, -t)).evaluate(Vector::Ones(1)),
                 entropy_above_one(t));
  }
  SUBCASE("a dilate, whose quotient is rounded") {
    const double x = std::nextafter(3.0, 4.0);
    check_near(dilate(entropy(), 3).evaluate(Vector::Constant(1, x)), entropy_above_one((x - 3) / 3));
  }
  SUBCASE("an affine map, whose sum is rounded") {
    const Function f = precompose(entropy(), Matrix{{1, 1}}, Vector::Constant(1, -1));
    check_near(f.evaluate(Vector{{2, 3e-17}}), entropy_above_one(3e-17));
  }
}

TEST_CASE("the error of a sum over entries is relative to the entries") {
  for (const double x : {0.2, 1e-200, 1e150}) {
    // -log x - log y = -log(1 + (x y - 1)).
    const double y = 1 / x, truth = -std::log1p(std::fma(x, y, -1));
    const Value found = log_barrier().evaluate(Vector{{x, y}});
    CHECK(std::abs(found.value - truth) <= found.error);
    CHECK(found.error <= 64 * unit_roundoff * std::abs(std::log(x)));
  }
}

TEST_CASE(
    "values of catalogue functions are within their errors where terms inside a formula cancel or a power "
    "enlarges rounding") {
  // Truths by 400 digits.
  const auto check_within = [](const Value& found, double truth) {
    CHECK(std::abs(found.value - truth) <= found.error + unit_roundoff * std::abs(truth));
    CHECK(found.error <= 1e-13 * std::abs(truth));
  };
  const auto one = [](double x) -> Vector { return Vector::Constant(1, x); };
  check_within(ball2(1, Vector{{1, -1}}).indicator.conjugate().evaluate(Vector{{-3e8, 2}}),
               -1.9999999933333334);
  check_within(power(4).conjugate().evaluate(one(3e8)), 94886174846.446789819);
  check_within(kullback_leibler(0x1p-10).evaluate(one(0.003)), 0.0013435489458562772706);
  check_within(kullback_leibler(3).evaluate(one(2)), 0.18906978378367123604);
  check_within(log_barrier(1).evaluate(one(3)), -0.098612288668109691395);
  check_within(exponential().conjugate().evaluate(one(2.5372174771608393)), -0.17489547737008182894);
  const Matrix Q{{20, 12, 14}, {12, 11, 6}, {14, 6, 15}};
  check_within(
      quadratic(Q, Vector{{193673961.87722474, 6, -3e8}}, -2).conjugate().evaluate(Vector{{-0.5, -3, -500}}),
      37870461699140694.339);
}

TEST_CASE("a linear form whose terms cancel is known to roundings of its terms") {
  for (const double x : {1.7, 1e-200, 1e270 / 7}) {
    const Vector at{{3 * x, x}};
    const long double truth = 0.1 * static_cast<long double>(at[0]) - 0.3 * static_cast<long double>(at[1]);
    const Value found = linear(Vector{{0.1, -0.3}}).evaluate(at);
    CHECK(std::abs(static_cast<double>(found.value - truth)) <= found.error);
    CHECK(found.error <= 64 * unit_roundoff * x);
  }
}

TEST_CASE("a supremum that is approached far out is not taken from the rounding of values there") {
  // -f tends to 4 where the slopes 6 and -6 cancel.
  const Function f =
      samples::function("precompose(sum(inverse_power(0.5), linear([2,-3,0])), [[3],[2],[1]], [-2,0,3])", 1);
  const Value found = f.conjugate().evaluate(Vector::Zero(1));
  CHECK(found.value - found.error <= 4);
  CHECK(found.value + found.error >= 4 - 1e-12);
  CHECK(found.value <= 4 + 1e-6);
}

TEST_CASE("the conjugate of t (x - log x) is +inf at t, where it is -t - t log 0, and not a large number") {
  const Function f = tilt(log_barrier(), Vector::Ones(1));
  for (const double t : {1.0, 0.5}) {
    const Value found = scale(f, t).conjugate().evaluate(Vector::Constant(1, t));
    CHECK(found.value == std::numeric_limits<double>::infinity());
    CHECK(found.error == 0);
  }
}

TEST_CASE("an inf-convolution attained at 5e5 is told within its error, and right to twelve digits") {
  // -sqrt(u_1) - sqrt(u_2 - 3) + 2^-10 |x - u - (0, -3)| is least at u = (524288.3, 524290.7).
  const Function f = samples::function(
      "inf_convolution(translate(negative_power(0.5), [0,3]), "
      "pointwise_max(sum_largest(2), distance(ball1(3), 0.0009765625)))",
      2);
  const Value found = f.evaluate(Vector{{0.035482444684021175, -0.93878487980691716}});
  CHECK(std::abs(found.value - -724.0767201739074586) <= found.error);
  CHECK(found.error <= 1e-12 * 724);
}

TEST_CASE("the value of an inf-convolution with a square moved far away keeps its digits") {
  // With p = W(e³), Lambert's function, e^u = 3 - u = p: p + p²/2.
  const Function f =
      samples::function("inf_convolution(exponential(), translate(squared_norm2(1), [1000000]))", 1);
  check_near(f.evaluate(Vector{{1000003}}), 4.64543962307249451838);
}
