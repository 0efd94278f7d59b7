#include <doctest/doctest.h>

#include <cmath>

#include "mechanics/expression/constraint_series.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace mechanics;
using expression::ConstraintSeries;
using expression::Rounded;
using expression::TimeSeries;

namespace {

/// x and y along x = 0.3 + 0.7 τ - 0.4 τ² + 0.5 τ³ + 0.2 τ⁴, y = 1.2 - 0.5 τ + 0.3 τ² - 0.8 τ³ + 0.1 τ⁴.
constexpr double x_motion[] = {0.3, 0.7, -0.4, 0.5, 0.2}, y_motion[] = {1.2, -0.5, 0.3, -0.8, 0.1};

double at(const double (&motion)[5], double time) {
  double value = 0;
  for (int k = 4; k >= 0; --k) value = value * time + motion[k];
  return value;
}

std::vector<TimeSeries> motion() {
  std::vector<TimeSeries> q(2);
  for (std::size_t k = 0; k < 5; ++k) {
    q[0].c[k] = x_motion[k];
    q[1].c[k] = y_motion[k];
  }
  return q;
}

std::unique_ptr<const LagrangianSystem> with(const std::string& f) {
  return tests::system({{"x", "y"}, "x'^2 + y'^2", "", {}, {}, {}, {{"f", f + " = 0"}}});
}

TimeSeries series(const LagrangianSystem& system, std::vector<TimeSeries> q, double t, int order) {
  TimeSeries time(t);
  time.c[1] = 1;
  return ConstraintSeries(system.model(), {0}).along(q, time, order)[0];
}

/// f at a moment minus the polynomial.
double remainder(const LagrangianSystem& system, const TimeSeries& f, double time) {
  double polynomial = 0;
  for (std::size_t k = 5; k-- > 0;) polynomial = polynomial * time + f.c[k].value;
  const State moment{0.4 + time, Vector::Zero(2), Vector::Zero(2)};
  State there = moment;
  there.q << at(x_motion, time), at(y_motion, time);
  return system.constraint_rates(there).f[0] - polynomial;
}

}  // namespace

TEST_CASE("where branches meet, derivatives from the right are those of the branch that a motion enters") {
  const auto derivative = [](const char* f, Rounded rate) {
    const auto system = with(f);
    std::vector<TimeSeries> q(2);
    q[0].c[1] = rate;
    q[1].c[2] = 1;
    return ConstraintSeries(system->model(), {0})
        .along(q, TimeSeries(0), 4, expression::Instant::after)[0]
        .c[3];
  };
  CHECK(derivative("abs(x)^3 + y^2", -1).value == 1);
  CHECK(derivative("max(x, 2*x)*y", -1).value == -1);
  CHECK(derivative("min(x, 2*x)*y", -1).value == -2);
  CHECK(derivative("if(x >= 0, x, 3*x)*y", -1).value == -3);
  CHECK(derivative("sign(x)*x*y", 1).value == 1);
  // A rate that may be 0 enters none.
  for (const char* f : {"max(x, 2*x)*y", "abs(x)*y", "sign(x)*y", "if(x >= 0, x, 2*x)*y"})
    CHECK_FALSE(std::isfinite(derivative(f, {1e-20, 1e-19}).value));
}

TEST_CASE("a constraint along a motion is its polynomial of degree four, but for the fifth power of time") {
  for (const char* f : {"x*y - x/y + 2^x - t*x", "sin(x*y) + cos(t + y)", "tan(x) + asin(x) - acos(x*y/2)",
                        "atan(y) + atan2(x, y) + atan2(-x, -y)", "sinh(x) - cosh(y)", "tanh(x*y)",
                        "exp(x) + log(y)", "sqrt(x + y) + abs(x - y)", "x^3 + y^-2 + y^0.7 + x^y",
                        "x^0 + (x - y)^5 + y^7 - 3", "-(x^2 + y^2)^1.5"}) {
    CAPTURE(f);
    const auto system = with(f);
    const TimeSeries along = series(*system, motion(), 0.4, 4);
    const double coarse = remainder(*system, along, 0.02), fine = remainder(*system, along, 0.01);
    CHECK(std::abs(coarse) <= 1e-6);
    // 2⁵ times as small at half the time; an error of the fourth derivative would make it 2⁴.
    CHECK(std::abs(fine) <= std::abs(coarse) / 24 + 1e-14);
  }
}

TEST_CASE("what integers give is exact, and says so") {
  const auto system = with("x^3*y - 5*x^2 + 0.5*y^2");
  std::vector<TimeSeries> q(2);
  for (std::size_t k = 0; k < 5; ++k) {
    q[0].c[k] = static_cast<double>(k) - 2;  // -2 - τ + τ³ + 2 τ⁴
    q[1].c[k] = 3 - static_cast<double>(k);  // 3 + 2 τ + τ² - τ⁴
  }
  const TimeSeries f = series(*system, q, 0, 4);
  // By hand: x³ = -8 - 12 τ - 6 τ² + 11 τ³ + 36 τ⁴ + …, x² = 4 + 4 τ + τ² - 4 τ³ - 10 τ⁴ + …,
  // y² = 9 + 12 τ + 10 τ² + 4 τ³ - 5 τ⁴ + …
  const double wanted[] = {-24 - 20 + 4.5, -36 - 16 - 20 + 6, -18 - 24 - 8 - 5 + 5, 33 - 12 - 12 + 20 + 2,
                           108 + 22 - 6 + 8 + 50 - 2.5};
  for (std::size_t k = 0; k < 5; ++k) {
    CAPTURE(k);
    CHECK(f.c[k].value == wanted[k]);
    CHECK(f.c[k].is_exact());
  }
  CHECK(f.derivative(4).value == 24 * wanted[4]);
}

TEST_CASE("radii cover what rounding did: a cancelled sum is 0 within its radius, not beyond") {
  const auto circle = with("sin(x)^2 + cos(x)^2 - 1"), tenth = with("0.1 + 0.2 - 0.3 + 0*x");
  const TimeSeries one = series(*circle, motion(), 0, 4), rest = series(*tenth, motion(), 0, 0);
  for (std::size_t k = 0; k < 5; ++k) CHECK(one.c[k].may_be_zero());
  CHECK(one.c[4].radius < 1e-13);
  CHECK(rest.c[0].value != 0);
  CHECK(rest.c[0].may_be_zero());
  CHECK(rest.c[0].radius < 1e-15);
}

TEST_CASE("a derivative that does not exist is not finite") {
  std::vector<TimeSeries> q(2);
  q[0].c[1] = 1;
  for (const char* f : {"abs(x)", "sqrt(x)", "x^2.5 + x", "log(x)", "1/x"}) {
    CAPTURE(f);
    const auto last = series(*with(f), q, 0, 4).c[4];
    CHECK_FALSE((std::isfinite(last.value) && std::isfinite(last.radius)));
  }
}
