#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

TEST_CASE("a ladder leaves a smooth wall at two thirds of its first height") {
  const SystemText text{{"x", "y", "a"},
                        "m/2*(x'^2 + y'^2) + m*l^2/24*a'^2",
                        "m*9.81*y",
                        {{"m", "3"}, {"l", "2"}},
                        {},
                        {},
                        {{"wall", "x >= l/2*cos(a)"}, {"floor", "y >= l/2*sin(a)"}}};
  for (const double start : {1.5, 1.2, 0.6}) {
    const Followed found = followed(text, state({std::cos(start), std::sin(start), start}, {0, 0, 0}), 0.5);
    const Followed later = followed(text, state({std::cos(start), std::sin(start), start}, {0, 0, 0}), 2.0);
    const std::vector<MotionEvent> released = later.of(EventKind::release);
    REQUIRE(released.size() >= 1);
    CHECK(released[0].constraints == std::vector<Index>{0});
    // m l²/3 a'²/2 = m g l/2 (sin a_0 - sin a), and the wall lets go where sin a = 2/3 sin a_0.
    const double rate = -std::sqrt(9.81 * 3 / 2 * std::sin(start) / 3);
    CHECK(released[0].velocity_before[2] == doctest::Approx(rate).epsilon(1e-13));
    CHECK(found.motion.status() == MotionStatus::done);
  }
}

TEST_CASE("a particle leaves a smooth cylinder where the cosine has fallen by a third") {
  const SystemText text{
      {"x", "y"}, "(x'^2 + y'^2)/2", "9.81*y", {}, {}, {}, {{"cylinder", "x^2 + y^2 >= 4"}}};
  const double start = 0.1;
  const Followed found = followed(text, state({2 * std::sin(start), 2 * std::cos(start)}, {0, 0}), 1.4);
  REQUIRE(found.events.size() == 1);
  CHECK(found.events[0].kind == EventKind::release);
  // v² = 2 g (y_0 - y) = g y at the release, y = 2/3 y_0.
  CHECK(found.events[0].velocity_before.squaredNorm() ==
        doctest::Approx(9.81 * 4 / 3 * std::cos(start)).epsilon(1e-13));
  const Vector v = found.events[0].velocity_before;
  CHECK(-v[1] / v.norm() ==
        doctest::Approx(std::sqrt(1 - std::pow(2 * std::cos(start) / 3, 2))).epsilon(1e-12));
}

TEST_CASE("a body leaves a shaken table when the table falls as fast as it") {
  const SystemText text = ball("y >= 0.1*sin(12*t)");
  const Followed found = followed(text, state({0}, {1.2}), 0.2);
  REQUIRE(found.events.size() == 1);
  CHECK(found.events[0].kind == EventKind::release);
  CHECK(std::abs(found.events[0].t - std::asin(9.81 / 14.4) / 12) <= 1e-15);
}

TEST_CASE("the first derivative that is not 0 decides whether a body at rest is lifted, and when") {
  const auto pushed = [](const char* force) {
    return SystemText{{"x"}, "x'^2/2", "", {}, {}, {{"x", force}}, {{"wall", "x >= 0"}}};
  };
  struct Case {
    const char* force;
    double position, release;  // at t = 1; when, after the beginning, or -1
  };
  for (const auto& [force, position, release] :
       {Case{"t", 1.0 / 6, -1}, Case{"-t", 0, -1}, Case{"t^3 - 0.5*t", -1, std::sqrt(0.5)},
        Case{"t^2", 1.0 / 12, -1}, Case{"-t^2*(2 - t)", 0, -1}, Case{"0", 0, -1}}) {
    CAPTURE(force);
    const Followed found = followed(pushed(force), state({0}, {0}), 1);
    CHECK(found.motion.status() == MotionStatus::done);
    if (position >= 0) CHECK(std::abs(found.end().q[0] - position) <= 1e-15);
    REQUIRE(found.events.size() == (release > 0 ? 1 : 0));
    if (release > 0) CHECK(std::abs(found.events[0].t - release) <= 1e-15);
  }
}

TEST_CASE("a table on four legs lets go two of them when the load passes the edge, and not before") {
  // Legs at (±1, ±1), mass 1 and weight 10 at the centre, the load 20 at (1.5 t, 0.3 t): all lambda >= 0
  // until the centre of the forces, (1.5 t, 0.3 t) 20/30, is outside the square: at t = 1.
  const SystemText text{{"z", "a", "b"},
                        "(z'^2 + a'^2/3 + b'^2/3)/2",
                        "10*z",
                        {},
                        {},
                        {{"z", "-20"}, {"a", "-20*1.5*t"}, {"b", "-20*0.3*t"}},
                        {{"east_north", "z + a + b >= 0"},
                         {"west_north", "z - a + b >= 0"},
                         {"west_south", "z - a - b >= 0"},
                         {"east_south", "z + a - b >= 0"}}};
  const Followed found = followed(text, state({0, 0, 0}, {0, 0, 0}), 1.1);
  REQUIRE(found.events.size() == 1);
  CHECK(found.events[0].kind == EventKind::release);
  CHECK(found.events[0].constraints == std::vector<Index>{1, 2});
  CHECK(std::abs(found.events[0].t - 1) <= 1e-14);
}

TEST_CASE("a string is slack at half its turn, and taut again on the circle") {
  const SystemText text{{"x", "y"}, "(x'^2 + y'^2)/2", "10*y", {}, {}, {}, {{"string", "x^2 + y^2 <= 1"}}};
  const Followed found = followed(text, state({0, -1}, {std::sqrt(35.0), 0}), 1.35199);
  REQUIRE(found.events.size() == 2);
  CHECK(found.events[0].kind == EventKind::release);
  CHECK(std::abs(found.events[0].t - 0.477393378664795955980534) <= 1e-14);
  CHECK(found.events[1].kind == EventKind::impact);
  CHECK(std::abs(found.events[1].t - 1.251990047906279333016387) <= 1e-13);
  CHECK(std::abs(found.end().q[0] + 0.1097289875283429760222784) <= 1e-12);
  CHECK(std::abs(found.end().v[1] - 0.1166038101590431841832241) <= 1e-11);
}

TEST_CASE("forces that cancel but for rounding do not lift a body, one that is small beside nothing does") {
  // The first is 0 by the theorem of addition, and 1e-7 by rounding.
  const std::string none = "1e9*sin(x + 1) - 1e9*(sin(x)*cos(1) + cos(x)*sin(1))";
  const auto height = [](const std::string& force, double x, double v) {
    const auto s = system({{"x", "y"}, "x'^2/2 + y'^2/2", "", {}, {}, {{"y", force}}, {{"floor", "y >= 0"}}});
    Motion motion(*s, state({x, 0}, {v, 0}), {});
    while (motion.advance(1)) {
    }
    return motion.state().q[1];
  };
  for (const double x : {0.1, 0.3, 0.7}) CHECK(std::abs(height(none, x, 0)) <= 1e-100);
  for (const double x : {0.1, 0.3, 0.7})
    CHECK(height("t + " + none, x, 0.2) == doctest::Approx(1.0 / 6).epsilon(1e-6));
  CHECK(height("1e-14", 0, 0) == doctest::Approx(5e-15).epsilon(1e-12));
}

TEST_CASE(
    "a slider with clearance, hammered and released, is never pulled, and turns its crank as "
    "known") {
  // Flores, Leine and Glocker 2010, without friction; the crank at t = 0.2 by extrapolated midpoints of 30
  // digits.
  const SystemText text{
      {"p1", "p2", "p3"},
      "m/2*(X1'^2 + Y1'^2 + X2'^2 + Y2'^2 + 2*X3'^2 + 2*Y3'^2) + 7.4e-5/2*p1'^2 + 5.9e-4/2*p2'^2 + "
      "2.7e-6/2*p3'^2",
      "9.81*m*(Y1 + Y2 + 2*Y3)",
      {{"m", "0.038"}, {"l1", "0.153"}, {"l2", "0.306"}, {"a", "0.05"}, {"b", "0.025"}, {"c", "0.001"}},
      {{"X1", "l1/2*cos(p1)"},
       {"Y1", "l1/2*sin(p1)"},
       {"X2", "l1*cos(p1) + l2/2*cos(p2)"},
       {"Y2", "l1*sin(p1) + l2/2*sin(p2)"},
       {"X3", "l1*cos(p1) + l2*cos(p2)"},
       {"Y3", "l1*sin(p1) + l2*sin(p2)"}},
      {},
      {{"upper_rear", "Y3 - a*sin(p3) + b*cos(p3) <= b + c"},
       {"upper_front", "Y3 + a*sin(p3) + b*cos(p3) <= b + c"},
       {"lower_rear", "Y3 - a*sin(p3) - b*cos(p3) >= -b - c"},
       {"lower_front", "Y3 + a*sin(p3) - b*cos(p3) >= -b - c"}}};
  const auto s = system(text);
  mechanics::Motion motion(*s, state({0, 0, 0}, {150, -75, 0}), restitution(text, 0.4));
  long releases = 0;
  while (motion.advance(0.2)) {
    for (const auto& event : motion.events()) releases += event.kind == mechanics::EventKind::release ? 1 : 0;
    CHECK(motion.multipliers().minCoeff() >= -1e-9);
  }
  CHECK(releases == 6);
  CHECK(motion.state().q[0] == doctest::Approx(18.1768772105354).epsilon(1e-12));
}

TEST_CASE("bodies struck where their springs are at rest part by the third derivative, in one event") {
  const SystemText text{{"x", "y", "z"},
                        "(0.754*x'^2 + 1.363*y'^2 + 0.637*z'^2)/2",
                        "3.022*x^2 + 1.234*z^2",
                        {},
                        {},
                        {},
                        {{"first", "y >= x"}, {"second", "z >= y"}}};
  const double T = 2.5, k = 2 * 3.022, c = 2 * 1.234;
  const Followed found = followed(text, state({-0.5, 0, 0}, {0.328, 0, 0}), T);
  // The first comes by its circle functions, all go on at one speed, and its spring holds it back more.
  const double w = std::sqrt(k / 0.754), amplitude = std::hypot(0.5, 0.328 / w);
  const double struck = std::atan2(0.5 * w, 0.328) / w, v = 0.754 * amplitude * w / (0.754 + 1.363 + 0.637);
  REQUIRE(found.events.size() == 1);
  CHECK(found.events[0].kind == EventKind::impact);
  CHECK(found.events[0].t == doctest::Approx(struck).epsilon(1e-14));
  const double slow = std::sqrt(c / (1.363 + 0.637)), since = T - struck;
  CHECK(found.end().q[0] == doctest::Approx(v / w * std::sin(w * since)).epsilon(1e-12));
  CHECK(found.end().q[1] == doctest::Approx(v / slow * std::sin(slow * since)).epsilon(1e-12));
  CHECK(found.end().q[2] == doctest::Approx(v / slow * std::sin(slow * since)).epsilon(1e-12));
}

TEST_CASE("a contact leaves where its push and that of the rod behind it come to 0 together") {
  // No force but the rod's presses the outer mass against the wall, so that at the release both multipliers
  // are 0 and no term is left to tell rounding by. With rods written twice this state leaves 2e-16 of one.
  const Lines rods{{"inner", "x^2 + y^2 - 1 = 0"}, {"outer", "(u - x)^2 + (w - y)^2 - 1 = 0"}};
  const Lines walls{
      {"left", "x + 1.29233 >= 0"}, {"wall", "u + 0.232815 >= 0"}, {"right", "0.547815 - u >= 0"}};
  const Lines again{{"again", "3*(x^2 + y^2 - 1) = 0"},
                    {"both", "(x^2 + y^2 - 1) - ((u - x)^2 + (w - y)^2 - 1) = 0"}};
  const auto pendulum = [&](bool twice) {
    SystemText text{
        {"x", "y", "u", "w"}, "(x'^2 + y'^2)/2 + 3*(u'^2 + w'^2)/2", "9.81*y + 29.43*w", {}, {}, {}, rods};
    text.constraints.insert(text.constraints.end(), walls.begin(), walls.end());
    if (twice) text.constraints.insert(text.constraints.end(), again.begin(), again.end());
    return text;
  };
  const State start =
      state({0.8643306729055112, -0.5029239384585965, -0.05081459366586039, -0.9060481638184888},
            {-0.09292267262990785, -0.15969793843686506, -1.0185744921562656, 1.9416540216852627});
  MotionOptions options;
  options.step_limit = 500;
  const Followed found = followed(pendulum(true), start, 1, options),
                 once = followed(pendulum(false), start, 1, options);
  REQUIRE(found.motion.status() == MotionStatus::done);
  const auto releases = found.of(EventKind::release), expected = once.of(EventKind::release);
  REQUIRE(releases.size() == 1);
  REQUIRE(expected.size() == 1);
  CHECK(releases[0].t == doctest::Approx(expected[0].t).epsilon(1e-13));
  CHECK((found.end().q - once.end().q).norm() <= 1e-12);
  CHECK((found.end().v - once.end().v).norm() <= 1e-12);
}

TEST_CASE(
    "a slope that rolls back lets go of a pendulum where it hangs, though its azimuth has no inertia there") {
  // With a sphere's angles T is not definite at th = 0. There the weight, -sin th, turns towards the motion's
  // end: th = 1/2 - 7/10 t at first, and th'' = -sin th from t = 5/7 on, with th' = -7/10.
  const SystemText text{{"th", "ph"},
                        "(th'^2 + sin(th)^2*ph'^2)/2",
                        "-cos(th)",
                        {},
                        {},
                        {},
                        {{"plane", "ph = 0"}, {"slope", "th >= 1/2 - 7/10*t"}}};
  const Followed found = followed(text, state({0.5, 0}, {-0.7, 0}), 3);
  REQUIRE(found.motion.status() == MotionStatus::done);
  REQUIRE(found.events.size() == 1);
  CHECK(found.events[0].kind == EventKind::release);
  CHECK(std::abs(found.events[0].t - 5.0 / 7) <= 1e-15);
  CHECK(std::abs(found.end().v[0] * found.end().v[0] / 2 + 1 - std::cos(found.end().q[0]) - 0.245) <= 1e-14);
}
