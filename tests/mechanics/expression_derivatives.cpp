#include <doctest/doctest.h>

#include <cmath>
#include <functional>

#include "tests/mechanics/system_text.hpp"

using namespace tests;

namespace {

/// Derivatives of F by central differences of step h, h/2, …, extrapolated (Richardson), in extended
/// precision.
long double richardson(const std::function<long double(long double)>& difference) {
  constexpr int levels = 8;
  long double table[levels][levels];
  long double h = 0.1L;
  for (int i = 0; i < levels; ++i, h /= 2) {
    table[i][0] = difference(h);
    long double power = 1;
    for (int j = 1; j <= i; ++j) {
      power *= 4;
      table[i][j] = table[i][j - 1] + (table[i][j - 1] - table[i - 1][j - 1]) / (power - 1);
    }
  }
  return table[levels - 1][levels - 1];
}

using F = std::function<long double(long double, long double)>;

struct Sample {
  const char* text;
  F f;  // the same in extended precision
};

const std::vector<Sample>& samples() {
  using std::pow;
  using R = long double;
  static const std::vector<Sample> table{
      {"sin(x*y)", [](R x, R y) { return std::sin(x * y); }},
      {"cos(x + 2*y)", [](R x, R y) { return std::cos(x + 2 * y); }},
      {"tan(x - y)", [](R x, R y) { return std::tan(x - y); }},
      {"asin(x*y/2)", [](R x, R y) { return std::asin(x * y / 2); }},
      {"acos(x*y/2)", [](R x, R y) { return std::acos(x * y / 2); }},
      {"atan(x/y)", [](R x, R y) { return std::atan(x / y); }},
      {"atan2(x, y)", [](R x, R y) { return std::atan2(x, y); }},
      {"atan2(x, 2)*atan2(-3, y)", [](R x, R y) { return std::atan2(x, R{2}) * std::atan2(R{-3}, y); }},
      {"sinh(x)*y", [](R x, R y) { return std::sinh(x) * y; }},
      {"cosh(x*y)", [](R x, R y) { return std::cosh(x * y); }},
      {"tanh(x + y)", [](R x, R y) { return std::tanh(x + y); }},
      {"exp(x*y)", [](R x, R y) { return std::exp(x * y); }},
      {"log(x + y^2)", [](R x, R y) { return std::log(x + y * y); }},
      {"sqrt(x^2 + y^2)", [](R x, R y) { return std::sqrt(x * x + y * y); }},
      {"abs(x - 3)*y", [](R x, R y) { return std::abs(x - 3) * y; }},
      {"x/y - 3/x + y/4", [](R x, R y) { return x / y - 3 / x + y / 4; }},
      {"x^3*y^-2", [](R x, R y) { return pow(x, R{3}) * pow(y, R{-2}); }},
      {"x^2.5 + x^1 + y^0", [](R x, R) { return pow(x, R{2.5}) + x + 1; }},
      {"x^y", [](R x, R y) { return pow(x, y); }},
      {"2^x*y", [](R x, R y) { return pow(R{2}, x) * y; }},
      {"-(x - y)*(x + y)", [](R x, R y) { return -(x - y) * (x + y); }},
      {"min(x*y, 2)*y", [](R x, R y) { return x * y * y; }},
      {"max(x, y^2, 1)", [](R, R y) { return y * y; }},
      {"ln(x)*hypot(x, y)", [](R x, R y) { return std::log(x) * std::sqrt(x * x + y * y); }},
      {"if(x < y, x*y^2, sqrt(x - y))", [](R x, R y) { return x * y * y; }},
      {"if(x >= y, sqrt(x - y), exp(x))*y", [](R x, R y) { return std::exp(x) * y; }},
      {"sign(x - y)*x^2 + step(y - x)*y^3", [](R x, R y) { return -x * x + y * y * y; }},
      {"abs(x - y)^3", [](R x, R y) { return pow(y - x, R{3}); }},
      // Through (0, 0), (1, 1), (2, 0): y'' = -3 at 1, so that it is 3u/2 - u³/2 up to there.
      {"table(x*y, [0, 1, 2], [0, 1, 0])", [](R x, R y) { return R{1.5} * x * y - pow(x * y, R{3}) / 2; }},
      {"table(x + y, [0, 1, 2.5], [0, 0, 0])*y", [](R, R) { return R{0}; }},
      {"-(-x)^3*y", [](R x, R y) { return pow(x, R{3}) * y; }},
  };
  return table;
}

constexpr double a0 = 0.7, b0 = 1.3, vx = 0.6, vy = -0.4;

/// F along the line (a0, b0) + s (vx, vy).
long double along(const F& f, long double s) { return f(a0 + s * vx, b0 + s * vy); }

long double first_along(const F& f) {
  return richardson([&](long double h) { return (along(f, h) - along(f, -h)) / (2 * h); });
}

long double second_along(const F& f) {
  return richardson([&](long double h) { return (along(f, h) - 2 * along(f, 0) + along(f, -h)) / (h * h); });
}

doctest::Approx near(long double expected) {
  return doctest::Approx(static_cast<double>(expected)).epsilon(1e-11);
}

}  // namespace

TEST_CASE("a constraint's rows and rates are the derivatives of its expression") {
  for (const auto& [text, f] : samples()) {
    CAPTURE(text);
    const auto s = system({{"x", "y"}, "x'^2 + y'^2", "", {}, {}, {}, {{"c", std::string(text) + " >= 0"}}});
    const auto at = state({a0, b0}, {vx, vy});
    const auto rates = s->constraint_rates(at);
    CHECK(rates.f[0] == near(along(f, 0)));
    CHECK(rates.df[0] == near(first_along(f)));
    const auto rows = s->contact_rows(at, {0});
    CHECK(-rows.s[0] == near(second_along(f)));
    const auto& g = f;
    CHECK(rows.U.coeff(0, 0) ==
          near(richardson([&](long double h) { return (g(a0 + h, b0) - g(a0 - h, b0)) / (2 * h); })));
    CHECK(rows.U.coeff(0, 1) ==
          near(richardson([&](long double h) { return (g(a0, b0 + h) - g(a0, b0 - h)) / (2 * h); })));
    mechanics::Vector q2(2);
    q2 << 0.25, -2;
    CHECK(s->second_rates(at, q2)[0] == doctest::Approx(rows.U.row(0).dot(q2) - rows.s[0]).epsilon(1e-13));
  }
}

TEST_CASE("a potential's force is minus its gradient") {
  for (const auto& [text, f] : samples()) {
    CAPTURE(text);
    const auto s = system({{"x", "y"}, "x'^2 + y'^2", text, {}, {}, {}, {}});
    const auto z = s->inertia(state({a0, b0}, {vx, vy})).z;
    const auto& g = f;
    CHECK(-z[0] ==
          near(richardson([&](long double h) { return (g(a0 + h, b0) - g(a0 - h, b0)) / (2 * h); })));
    CHECK(-z[1] ==
          near(richardson([&](long double h) { return (g(a0, b0 + h) - g(a0, b0 - h)) / (2 * h); })));
  }
}

TEST_CASE("the prime is the derivative along the motion") {
  for (const auto& [text, f] : samples()) {
    CAPTURE(text);
    const auto s = system({{"x", "y"}, "x'^2 + y'^2", "", {}, {{"F", text}}, {{"x", "F'"}}, {}});
    CHECK(s->inertia(state({a0, b0}, {vx, vy})).z[0] == near(first_along(f)));
  }
}

TEST_CASE("a particle on the line F has the mass F_q^2 and the force -F_q F_qq q'^2") {
  // T = (F')²/2 with F = F(x): A = F_x², z = -F_x F_xx x'².
  for (const auto& [text, f] : samples()) {
    CAPTURE(text);
    const auto s = system({{"x"}, "F'^2/2", "", {{"y", "1.3"}}, {{"F", text}}, {}, {}});
    const auto& g = f;
    const long double first =
        richardson([&](long double h) { return (g(a0 + h, b0) - g(a0 - h, b0)) / (2 * h); });
    const long double second =
        richardson([&](long double h) { return (g(a0 + h, b0) - 2 * g(a0, b0) + g(a0 - h, b0)) / (h * h); });
    const auto inertia = s->inertia(state({a0}, {vx}));
    CHECK(inertia.A.coeff(0, 0) == near(first * first));
    CHECK(inertia.z[0] == near(-first * second * vx * vx));
  }
}

TEST_CASE("time counts as a variable that moves at the rate 1") {
  // f = x sin(w t) + t²: f_tt = -w² x sin + 2, f_qt = w cos
  const double w = 3, t = 0.4, x = 0.8, v = -1.5;
  const auto s =
      system({{"x"}, "x'^2", "", {{"w", "3"}}, {}, {{"x", "(x*t^2)'"}}, {{"c", "x*sin(w*t) + t^2 >= 0"}}});
  const auto at = state({x}, {v}, t);
  const auto rates = s->constraint_rates(at);
  CHECK(rates.df[0] == doctest::Approx(v * std::sin(w * t) + w * x * std::cos(w * t) + 2 * t));
  CHECK(rates.df_scale[0] ==
        doctest::Approx(std::max(std::abs(v * std::sin(w * t)), w * x * std::cos(w * t) + 2 * t)));
  CHECK(s->contact_rows(at, {0}).s[0] ==
        doctest::Approx(-(2 * w * std::cos(w * t) * v - w * w * x * std::sin(w * t) + 2)));
  CHECK(s->inertia(at).z[0] == doctest::Approx(v * t * t + 2 * x * t));
}
