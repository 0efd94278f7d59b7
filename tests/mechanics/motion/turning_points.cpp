#include "mechanics/motion/turning_point.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

std::string digits(double x) {
  std::string text(32, ' ');
  text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.17g", x)));
  return text;
}

/// A mass between walls A sin(2 pi t) ± 1 with e = 0.7, over A in a unit.
OrbitFamily impact_pair(double unit = 1) {
  return {[unit](double A) {
            return system({{"x"},
                           "x'^2/2",
                           "",
                           {{"A", digits(A / unit)}},
                           {},
                           {},
                           {{"lower", "x - A*sin(2*pi*t) >= -1"}, {"upper", "x - A*sin(2*pi*t) <= 1"}}});
          },
          [](const LagrangianSystem&, double) {
            OrbitQuestion question;
            question.motion.restitution = Vector{{0.7, 0.7}};
            question.period = 1;
            return question;
          },
          unit};
}

}  // namespace

TEST_CASE("the symmetric orbit of the impact pair folds where its two phases meet, at A = k/root(1 + k²)") {
  const OrbitFamily family = impact_pair();
  const double pi = std::acos(-1.0), k = 2 / pi * 0.3 / 1.7, A = 0.115;
  // The orbit by its closed form, at t = 0.25 of the period before the impact on the upper wall.
  const double phase = std::atan(k) + std::acos(-(k / A) / std::sqrt(1 + k * k));
  const double speed = 4 * (A * std::sin(phase) + 1), impact = phase / (2 * pi), t = impact - 0.25;
  const State start{t, Vector{{A * std::sin(phase) + 1 - 0.25 * speed}}, Vector{{speed}}};
  const auto made = family.system(A);
  const Orbit near = find_orbit(*made, start, family.question(*made, A));
  REQUIRE(near.is_found);
  REQUIRE(std::abs(near.start.v[0] - speed) <= 1e-11);
  const auto fold = find_turning_point(family, A, near, family.range);
  REQUIRE(fold);
  CHECK(std::abs(fold->value - k / std::sqrt(1 + k * k)) <= 1e-12);
  REQUIRE(fold->orbit.multipliers);
  CHECK(std::abs((*fold->orbit.multipliers)[0] - 1.0) <= 1e-6);
  // Beside it the two phases, each on its side.
  for (const double distance : {-0.01, 0.01}) {
    const auto beside = orbit_beside(family, *fold, distance);
    REQUIRE(beside);
    CHECK(beside->value > fold->value);
    const double either = std::acos(-(k / beside->value) / std::sqrt(1 + k * k));
    const double first = 4 * (beside->value * std::sin(std::atan(k) + either) + 1),
                 second = 4 * (beside->value * std::sin(std::atan(k) - either) + 1);
    const double found = beside->orbit.start.v[0];
    CHECK(std::min(std::abs(found - first), std::abs(found - second)) <= 1e-10);
  }
  const double one = orbit_beside(family, *fold, -0.01)->orbit.start.v[0],
               other = orbit_beside(family, *fold, 0.01)->orbit.start.v[0];
  CHECK((one - fold->orbit.start.v[0]) * (other - fold->orbit.start.v[0]) < 0);
}

TEST_CASE("the unit of a parameter does not decide whether a fold is found") {
  const double k = 2 / std::acos(-1.0) * 0.3 / 1.7, A = 0.115;
  for (const double unit : {1e-9, 1e9}) {
    const OrbitFamily family = impact_pair(unit);
    const double phase = std::atan(k) + std::acos(-(k / A) / std::sqrt(1 + k * k));
    const double speed = 4 * (A * std::sin(phase) + 1), t = phase / (2 * std::acos(-1.0)) - 0.25;
    const auto made = family.system(A * unit);
    const Orbit near =
        find_orbit(*made, {t, Vector{{A * std::sin(phase) + 1 - 0.25 * speed}}, Vector{{speed}}},
                   family.question(*made, A * unit));
    REQUIRE(near.is_found);
    const auto fold = find_turning_point(family, A * unit, near, family.range);
    REQUIRE(fold);
    CHECK(std::abs(fold->value / unit - k / std::sqrt(1 + k * k)) <= 1e-12);
  }
}

TEST_CASE("a branch that does not turn has no turning point nearby") {
  const OrbitFamily family{
      [](double w) {
        return system({{"x"}, "x'^2/2", "2*x^2", {{"w", digits(w)}}, {}, {{"x", "cos(w*t) - 0.3*x'"}}, {}});
      },
      [](const LagrangianSystem&, double w) {
        OrbitQuestion question;
        question.period = 2 * std::acos(-1.0) / w;
        return question;
      }};
  const auto made = family.system(1.5);
  const Orbit orbit = find_orbit(*made, state({0.5}, {0}), family.question(*made, 1.5));
  REQUIRE(orbit.is_found);
  CHECK_FALSE(find_turning_point(family, 1.5, orbit, family.range));
}

TEST_CASE("a fold is looked for no further from an orbit than it is asked for") {
  // A forced oscillator before a stop has no fold near c = 0.1: Newton's method doubled c at each step, and
  // followed motions of ever more impacts.
  double farthest = 0;
  const OrbitFamily family{[&](double c) {
                             farthest = std::max(farthest, c);
                             return system({{"x"},
                                            "x'^2/2",
                                            "x^2/2",
                                            {{"c", digits(c)}},
                                            {},
                                            {{"x", "cos(0.9*t) - c*x'"}},
                                            {{"stop", "x <= 0.5"}}});
                           },
                           [](const LagrangianSystem&, double) {
                             OrbitQuestion question;
                             question.motion.restitution = Vector{{0.7}};
                             question.period = 2 * std::acos(-1.0) / 0.9;
                             return question;
                           },
                           1};
  const auto made = family.system(0.1);
  const Orbit orbit = find_orbit(*made, state({0}, {0}), family.question(*made, 0.1));
  REQUIRE(orbit.is_found);
  CHECK_FALSE(find_turning_point(family, 0.1, orbit, 2));
  CHECK(farthest <= 2.2);
}

TEST_CASE("a self-excited circle of free period folds where its two radii meet, and both are beside it") {
  // x'' = -x + (m + r² - r⁴) x', r² = x² + x'²: circles of period 2 pi with r⁴ - r² = m, down to m = -1/4.
  const OrbitFamily family{[](double m) {
                             return system({{"x"},
                                            "x'^2/2",
                                            "x^2/2",
                                            {{"m", digits(m)}},
                                            {},
                                            {{"x", "(m + x^2 + x'^2 - (x^2 + x'^2)^2)*x'"}},
                                            {}});
                           },
                           [](const LagrangianSystem&, double) {
                             OrbitQuestion question;
                             question.is_free = true;
                             return question;
                           }};
  const double m = -0.24, radius = std::sqrt((1 + std::sqrt(1 + 4 * m)) / 2);
  const auto made = family.system(m);
  const Orbit near = find_orbit(*made, state({1.02 * radius}, {0}), family.question(*made, m));
  REQUIRE(near.is_found);
  const auto fold = find_turning_point(family, m, near, family.range);
  REQUIRE(fold);
  CHECK(std::abs(fold->value + 0.25) <= 1e-10);
  CHECK(std::abs(fold->orbit.period - 2 * std::acos(-1.0)) <= 1e-9);
  for (const double distance : {-0.01, 0.01}) {
    const auto beside = orbit_beside(family, *fold, distance);
    REQUIRE(beside);
    const double square = beside->orbit.start.q[0] * beside->orbit.start.q[0] +
                          beside->orbit.start.v[0] * beside->orbit.start.v[0];
    CHECK(std::abs(square * square - square - beside->value) <= 1e-9);
    CHECK((square > 0.5) == (distance * fold->along[0] * fold->orbit.start.q[0] > 0));
  }
}
