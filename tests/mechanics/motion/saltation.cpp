#include "mechanics/motion/saltation.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "convex/linear_algebra/complex_eigenvalues.hpp"
#include "mechanics/motion/period_map.hpp"
#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

constexpr double full_turn = 6.283185307179586;

/// Two pendulums one below the other, shaken, beside a wall.
SystemText pendulums_at_wall() {
  return {{"a", "b"},
          "a'^2 + b'^2/2 + a'*b'*cos(a - b)",
          "-9.81*(2*cos(a) + cos(b))",
          {},
          {},
          {{"a", "3*cos(3*t) - 0.3*a'"}, {"b", "-0.3*b'"}},
          {{"wall", "sin(a) + sin(b) <= 0.05*(1 + sin(t))"}}};
}

/// The same derivative from motions beside it: an oracle good to about 1e-8.
struct Compared {
  FlowDerivative exact;
  std::optional<convex::Matrix> differences;
  std::vector<MotionEvent> events;
  long count(EventKind kind) const {
    return std::count_if(events.begin(), events.end(), [&](const auto& event) { return event.kind == kind; });
  }
};

Compared compared(const SystemText& text, const State& start, double period, double e) {
  const auto made = system(text);
  OrbitQuestion question;
  question.motion = restitution(text, e);
  question.motion.tolerance = 1e-13;
  const PeriodMap map(*made, start.t, question);
  const TangentChart chart(*made, start);
  const Flight flight = map.fly(as_one(chart.origin()), period);
  REQUIRE(flight.arrives);
  constexpr double step = 1e-4;
  constexpr int levels = 3;
  return {map.derivative(chart, flight), map.differences(chart, period, flight, step, levels, false),
          flight.events()};
}

void check_alike(const Compared& found) {
  REQUIRE(found.exact.kind == FlowDerivative::Kind::known);
  REQUIRE(found.differences);
  CHECK((found.exact.value - *found.differences).norm() <= 2e-8 * found.differences->norm());
}

}  // namespace

TEST_CASE("along smooth arcs the derivative is that of differences") {
  SystemText text = pendulums_at_wall();
  text.constraints.clear();
  const Compared found = compared(text, state({0.4, -0.3}, {0.1, 0.5}), 2, 0);
  CHECK(found.events.empty());
  check_alike(found);
}

TEST_CASE("impacts on a moving wall are in the derivative") {
  const Compared found = compared(pendulums_at_wall(), state({-0.2, 0.1}, {0.5, 0.3}), 2, 0.7);
  CHECK(found.count(EventKind::impact) >= 2);
  check_alike(found);
}

TEST_CASE("a contact at rest lowers the rank, and its release leaves it so") {
  const Compared found = compared(pendulums_at_wall(), state({-0.2, 0.1}, {0.5, 0.3}), 2.5, 0);
  CHECK(found.count(EventKind::impact) >= 1);
  CHECK(found.count(EventKind::release) >= 1);
  check_alike(found);
  const auto values = convex::linear_algebra::complex_eigenvalues(found.exact.value);
  CHECK(std::abs(values[2]) <= 1e-12 * std::abs(values[0]));
  CHECK(std::abs(values[3]) <= 1e-12 * std::abs(values[0]));
}

TEST_CASE("inertia that depends on time and place is in the derivative of an impact") {
  const SystemText text{{"x", "y"},
                        "(2 + sin(t) + x^2)*x'^2/2 + y'^2/2 + 0.3*x'*y'*cos(x*y) + x'*t*0.1",
                        "2*x^2 + y^2/2",
                        {},
                        {},
                        {{"x", "cos(1.5*t)"}},
                        {{"wall", "x + 0.2*y^2 <= 0.35 + 0.1*sin(3*t)"}}};
  const Compared found = compared(text, state({0.1, 0.4}, {0.9, -0.3}), 5, 0.6);
  CHECK(found.count(EventKind::impact) >= 2);
  check_alike(found);
}

TEST_CASE("a force that jumps has its saltation matrix") {
  const SystemText text{{"x"},   "x'^2/2",
                        "x^2/2", {},
                        {},      {{"x", "2*cos(0.7*t) - 0.3*sign(x') + 0.4*abs(x) + 0.3*max(x - 0.5, 0.2)"}},
                        {}};
  const Compared found = compared(text, state({1}, {0.3}), full_turn / 0.7, 0);
  CHECK(found.count(EventKind::branch) >= 2);
  check_alike(found);
}

TEST_CASE("impacts on two-sided constraints vary along them alone") {
  SystemText text{{"x", "y"},
                  "(x'^2 + y'^2)/2",
                  "9.81*y",
                  {},
                  {},
                  {{"x", "2*cos(3*t)"}},
                  {{"rod", "x^2 + y^2 = 1"}, {"wall", "x <= 0.1"}}};
  const Compared found = compared(text, state({-0.2, -std::sqrt(0.96)}, {0.5, 0}), 2, 0.8);
  CHECK(found.count(EventKind::impact) >= 2);
  CHECK(found.exact.value.rows() == 2);
  check_alike(found);
}

TEST_CASE("impacts at once have a derivative where their order does not matter, and none where it does") {
  SystemText text{{"x", "y"},
                  "(x'^2 + y'^2)/2",
                  "2*(x^2 + y^2)",
                  {},
                  {},
                  {{"x", "cos(1.5*t)"}, {"y", "cos(1.5*t)"}},
                  {{"a", "x <= 0.35"}, {"b", "y <= 0.35"}}};
  const State start = state({0.3, 0.3}, {0.2, 0.2});
  const Compared both = compared(text, start, full_turn / 1.5, 0.5);
  REQUIRE(both.count(EventKind::impact) >= 1);
  REQUIRE(both.events[0].constraints.size() == 2);
  REQUIRE(both.exact.kind == FlowDerivative::Kind::known);
  // Each alone.
  const SystemText alone{{"x"}, "x'^2/2", "2*x^2", {}, {}, {{"x", "cos(1.5*t)"}}, {{"a", "x <= 0.35"}}};
  const Compared one = compared(alone, state({0.3}, {0.2}), full_turn / 1.5, 0.5);
  check_alike(one);
  for (Index i : {0, 1})
    for (Index j : {0, 1})
      for (Index of : {0, 1}) {
        CHECK(both.exact.value(2 * i + of, 2 * j + of) ==
              doctest::Approx(one.exact.value(i, j)).epsilon(1e-12));
        CHECK(std::abs(both.exact.value(2 * i + of, 2 * j + 1 - of)) <= 1e-13);
      }
  text.kinetic = "(x'^2 + y'^2)/2 + 0.3*x'*y'";
  CHECK(compared(text, start, full_turn / 1.5, 0.5).exact.kind == FlowDerivative::Kind::none);
}

TEST_CASE("where a contact is grazed there is no derivative") {
  // x = cos t comes to x = 1 with no speed.
  const SystemText text{{"x"}, "x'^2/2", "x^2/2", {}, {}, {}, {{"stop", "x <= 1"}}};
  const Compared found = compared(text, state({0}, {-1}), 6, 0.5);
  CHECK((found.events.empty() || found.exact.kind == FlowDerivative::Kind::none));
}
