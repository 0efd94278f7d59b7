#include "mechanics/jet_system.hpp"

#include <doctest/doctest.h>

#include "tests/mechanics/system_text.hpp"

using namespace tests;

namespace {

/// Two rods, hinged to a point that moves as sin t; the tip stays left of a wall that moves off as t²/4.
struct DoublePendulum {
  static constexpr int coordinates = 2, constraints = 2;
  double m = 1.5, n = 0.75, l = 1.25, k = 0.5, g = 9.81;

  template <class S>
  S kinetic(const std::array<S, 2>& q, const std::array<S, 2>& v, const S& t) const {
    const S x = cos(t) + l * cos(q[0]) * v[0], y = l * sin(q[0]) * v[0];
    S T = S(0.0);
    T += 0.5 * m * (x * x + y * y);
    T += n / 2 * (pow(x + k * cos(q[1]) * v[1], 2) + pow(y + k * sin(q[1]) * v[1], 2));
    return T;
  }
  template <class S>
  S potential(const std::array<S, 2>& q, const S&) const {
    return -m * g * l * cos(q[0]) - n * g * (l * cos(q[0]) + k * cos(q[1])) + 1 - 1.0;
  }
  std::array<double, 2> forces(const std::array<double, 2>&, const std::array<double, 2>& v, double) const {
    return {-2 * std::abs(v[0]), 0};
  }
  template <class S>
  std::array<S, 2> f(const std::array<S, 2>& q, const S& t) const {
    return {3 + t * t / 4 - (sin(t) + l * sin(q[0]) + k * sin(q[1])),
            abs(q[0] - 7) - sqrt(1 + pow(q[1], 3.0)) * exp(-t)};
  }
};

SystemText double_pendulum_text() {
  return {{"a", "b"},
          "m/2*(x'^2 + y'^2) + n/2*((x + k*sin(b))'^2 + (y - k*cos(b))'^2)",
          "m*g*y + n*g*(y - k*cos(b))",
          {{"m", "1.5"}, {"n", "0.75"}, {"l", "1.25"}, {"k", "0.5"}, {"g", "9.81"}},
          {{"x", "sin(t) + l*sin(a)"}, {"y", "-l*cos(a)"}},
          {{"a", "-2*abs(a')"}},
          {{"wall", "x + k*sin(b) <= 3 + t^2/4"}, {"odd", "abs(a - 7) >= sqrt(1 + b^3)*exp(-t)"}}};
}

}  // namespace

TEST_CASE("a system of C++ functions is the system of the same text") {
  const mechanics::JetSystem<DoublePendulum> jets({}, {"a", "b"}, {{"wall", false, {}}, {"odd", false, {}}});
  const auto text = system(double_pendulum_text());
  for (const auto& at :
       {state({0.4, 1.1}, {2, -3}, 0.3), state({-1, 0.25}, {0.5, 4}, -2), state({2, 0}, {0, 0})}) {
    constexpr double rounding = 1e-13;
    const auto expected = text->inertia(at), found = jets.inertia(at);
    CHECK(found.A.isApprox(expected.A, rounding));
    CHECK(found.z.isApprox(expected.z, rounding));
    const auto rates = jets.constraint_rates(at), expected_rates = text->constraint_rates(at);
    CHECK(rates.f.isApprox(expected_rates.f, rounding));
    CHECK((rates.df - expected_rates.df).norm() <= rounding);
    CHECK(rates.df_scale.isApprox(expected_rates.df_scale, rounding));
    const auto rows = jets.contact_rows(at, {1, 0}), expected_rows = text->contact_rows(at, {1, 0});
    CHECK((Eigen::MatrixXd(rows.U) - Eigen::MatrixXd(expected_rows.U)).norm() <= rounding);
    CHECK((rows.s - expected_rows.s).norm() <= 20 * rounding);
    const mechanics::Vector q2 = mechanics::Vector::LinSpaced(2, -1, 3);
    CHECK((jets.second_rates(at, q2) - text->second_rates(at, q2)).norm() <= 20 * rounding);
    CHECK(jets.energy(at) == doctest::Approx(text->energy(at)));
  }
}

TEST_CASE("a system of C++ functions refuses a state where a derivative does not exist") {
  const mechanics::JetSystem<DoublePendulum> jets({}, {"a", "b"}, {{"wall", false, {}}, {"odd", false, {}}});
  CHECK(error_of([&] {
          jets.constraint_rates(state({0, -1}, {0, 0}));
        }).find("constraint odd") != std::string::npos);
}
