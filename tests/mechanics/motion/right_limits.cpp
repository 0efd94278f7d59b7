#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/mechanics/motion/followed.hpp"

using namespace tests;
using mechanics::MotionStatus;

TEST_CASE("an argument that stays 0 has its value there, while one beside it leaves 0") {
  struct Case {
    const char *x, *y;
    mechanics::State start;
    double until, q, v;  // of x
  };
  // v' = 1 - v² from rest is v = tanh t; y' stays 0, x' does not.
  const Case cases[] = {
      {"if(y' <= 0, 1, 0) - sign(x')*x'^2", "0", state({0, 0}, {0, 0}), 1, std::log(std::cosh(1.0)),
       std::tanh(1.0)},
      // y = -t, and |y| is the force on x: x' < x' is never so.
      {"if(x' < x', 5, abs(y))", "if(y' < y', 5, 0)", state({0, 0}, {0, -1}), 2, 8.0 / 6, 2},
      // x' comes to 0 at ln 2, where the step jumps from beyond x' to it.
      {"min(x', step(x')) - 1", "0", state({0, 0}, {0.5, 0}), 1, 1 - (std::exp(1.0) - 1) / 2,
       1 - std::exp(1.0) / 2},
      // y = 1 - sin t comes to 0 at π/2 without a velocity, and goes on above.
      {"0", "step(y) - y", state({0, 1}, {0, -1}), 2, 0, 0}};
  for (const Case& one : cases) {
    CAPTURE(one.x);
    const Followed motion = followed(
        {{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"x", one.x}, {"y", one.y}}, {}}, one.start, one.until);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(one.q).epsilon(1e-11));
    CHECK(motion.end().v[0] == doctest::Approx(one.v).epsilon(1e-11));
    if (one.until == 2 && one.q == 0)
      CHECK(motion.end().q[1] == doctest::Approx(1 - std::sin(2.0)).epsilon(1e-11));
  }
}

TEST_CASE("at rest at the bottom of a potential with a kink a body stays, and moves along it") {
  for (const char* V : {"sqrt(4*x^2)", "abs(x)", "abs(cos(atan2(-1/2, x)))"}) {
    CAPTURE(V);
    const Followed motion = followed(
        {{"x", "y"}, "(x'^2+y'^2)/2", std::string(V) + " + y^2/2", {}, {}, {}, {}}, state({0, 1}, {0, 0}), 2);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == 0);
    CHECK(motion.end().q[1] == doctest::Approx(std::cos(2.0)).epsilon(1e-11));
    CHECK(motion.motion.record().steps < 100);
  }
}

TEST_CASE("where both arguments of atan2 come to 0 the motion stops, for the angle jumps there") {
  for (const char* force : {"abs(atan2(x, x))", "sqrt(4*atan2(x, x)^2)", "sign(atan2(x, x))"}) {
    CAPTURE(force);
    const Followed motion = followed({{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"y", force}}, {}},
                                     state({-0.4863, 0}, {0.7, 0}), 2);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(motion.motion.why().find("atan2") != std::string::npos);
    CHECK(motion.end().t == doctest::Approx(0.4863 / 0.7).epsilon(1e-12));
  }
}

TEST_CASE("an angle above the origin jumps where its height changes its sign, and a branch with it") {
  // x'' = -x from -1 with x' = 0.3, and 1 - x from the time at which x = 0, where atan2(x, 0) jumps to π/2.
  for (const char* angle : {"atan2(x, 0)", "atan2(x, step(-1))"}) {
    CAPTURE(angle);
    const Followed motion =
        followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "step(" + std::string(angle) + ") - x"}}, {}},
                 state({-1}, {0.3}), 2);
    const double left = 2 - std::atan2(1, 0.3), speed = std::sqrt(1.09);
    CHECK(motion.end().q[0] == doctest::Approx(1 - std::cos(left) + speed * std::sin(left)).epsilon(1e-12));
  }
}

TEST_CASE("an argument that is not 0 once others have left 0 has its own sign, however fast it falls") {
  struct Case {
    const char* force;
    mechanics::State start;
    double until, v;  // of y
  };
  const Case cases[] = {
      {"max(if(t > 0, exp(-50*t) + 1e-3, 0), 0)", state({0, 0}, {0, 0}), 1, (1 - std::exp(-50)) / 50 + 1e-3},
      {"sign(if(x > 0, 1 + 0.5*cos(100*t), 0))", state({0, 0}, {1, 0}), 1, 1},
      {"sign(if(x > 0, 2 - 1e6*x, 0))", state({-1, 0}, {1, 0}), 1.000001, 1e-6}};
  for (const Case& one : cases) {
    CAPTURE(std::string(one.force));
    const Followed motion =
        followed({{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"y", one.force}}, {}}, one.start, one.until);
    CHECK(motion.end().v[1] == doctest::Approx(one.v).epsilon(1e-8));
  }
}

TEST_CASE("bodies that friction brings to rest at once stay there, however many") {
  SystemText text;
  convex::Vector q(6), v(6);
  for (int i = 0; i < 6; ++i) {
    const std::string a = "a" + std::to_string(i);
    text.coordinates.push_back(a);
    text.kinetic += (i > 0 ? " + " : "") + a + "'^2/2";
    text.forces.push_back({a, "-sign(" + a + "')"});
    q[i] = 0;
    v[i] = i < 4 ? 1 : 1.5;
  }
  const Followed motion = followed(text, {0, q, v}, 3);
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.end().v.norm() <= 1e-14);
  CHECK(motion.end().q[0] == doctest::Approx(0.5).epsilon(1e-12));
  CHECK(motion.end().q[5] == doctest::Approx(1.125).epsilon(1e-12));
}

TEST_CASE("of contacts with one gradient at rest those push that the others follow from once a body moves") {
  const std::vector<std::pair<std::string, std::string>> all[] = {
      {{"floor", "y >= 0"}, {"bowl", "y >= x^2"}},
      {{"bowl", "3*y >= 3*x^2"}, {"dome", "y >= -x^2"}, {"floor", "y >= 0"}, {"again", "y >= x^2"}},
      {{"a", "y >= x^2/2"}, {"b", "2*y >= x^2"}, {"c", "y >= x^2"}, {"d", "y >= 0"}, {"e", "y >= x^3/9"}}};
  for (const auto& constraints : all) {
    const Followed motion = followed({{"x", "y"}, "(x'^2+y'^2)/2", "9.81*y - x", {}, {}, {}, constraints},
                                     state({0, 0}, {0, 0}), 0.5);
    REQUIRE(motion.motion.status() == MotionStatus::done);
    const auto& [t, q, v] = motion.end();
    const double x = q[0];
    CHECK(x > 0.01);
    CHECK(q[1] == doctest::Approx(x * x).epsilon(1e-12));  // on the bowl, and with the energy of the start
    CHECK(v[0] == doctest::Approx(std::sqrt(2 * (x - 9.81 * x * x) / (1 + 4 * x * x))).epsilon(1e-10));
    CHECK(v[1] == doctest::Approx(2 * x * v[0]).epsilon(1e-12));
  }
}

TEST_CASE("at rest contacts of one gradient that no motion satisfies exclude each other") {
  const Followed motion =
      followed({{"x", "y"}, "(x'^2+y'^2)/2", "y - x", {}, {}, {}, {{"bowl", "y >= x^2"}, {"lid", "y <= 0"}}},
               state({0, 0}, {0, 0}), 1);
  CHECK(motion.motion.status() == MotionStatus::infeasible);
}

TEST_CASE(
    "a slide that begins so soon after the start that the force away from it is tiny stops the motion") {
  // x'' = -15 from 0.4 + d comes to 0.4 at d/15; below it the force pushes back, however little yet.
  for (const char* force : {"if(x' > 0.4, -15, t)", "-15*step(x' - 0.4) + sin(3*t)", "-15*step(x' - 0.4) + t",
                            "if(x' > 0.4, -15, x - 1)", "if(x' > 0.4, -15, 1 - cos(t))"})
    for (const double d : {1e-10, 1e-8, 1e-6, 1e-3}) {
      CAPTURE(std::string(force));
      CAPTURE(d);
      const Followed motion = pushed(force, 1, 0.4 + d, 1);
      CHECK(motion.motion.status() == MotionStatus::stopped);
      CHECK(motion.motion.why().find("slides") != std::string::npos);
      CHECK(motion.end().t == doctest::Approx(d / 15).epsilon(1e-3));
    }
}

TEST_CASE("a motion does not go on in a branch that its text has nowhere on that side of an edge") {
  struct Case {
    const char* force;
    double x, v, t;  // t: where both sides lead back to the edge
  };
  // max(A, 0) is 0 on all of one side, where max(A, 0) <= 0 holds.
  const Case cases[] = {{"if(max(x', 0) <= 0, 1, -1)", 0, 0, 0},
                        {"if(max(x' - 0.5, 0) <= 0, 1, -1)", 0, 0, 0.5},
                        {"-x'*if(max(x' - cos(t), 0) <= 0, 0, 1)", 1, 1, 0},
                        {"1 - 3*sign(max(x', 0))", 0, -0.5, 0.5},
                        {"if(max(x', 0)^2 > 0, -3, 1)", 0, -0.5, 0.5},
                        {"if(abs(x') + x' > 0, -3, 1)", 0, -0.5, 0.5},
                        {"if(max(x - sin(t), 0) > 0, -3, 1)", 0, 1, 0}};
  for (const Case& one : cases) {
    CAPTURE(std::string(one.force));
    const Followed motion =
        followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", one.force}}, {}}, state({one.x}, {one.v}), 2);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(motion.motion.why().find("slides") != std::string::npos);
    CHECK(motion.end().t == doctest::Approx(one.t).epsilon(1e-12));
  }
  // Beyond the edge nothing pushes: the velocity stays at it.
  for (const char* force : {"if(max(x', 0) > 0, -1, 0)", "if(max(x', 0) <= 0, 0, -1)", "-sign(max(x', 0))"}) {
    CAPTURE(std::string(force));
    const Followed motion = pushed(force, 0, 0.5, 2);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(0.125).epsilon(1e-12));
  }
}

TEST_CASE("a body moves freely along a floor that another one touches to a high order") {
  // ∫∫ sin³ t, along y = 0.
  const double T = 2, s = std::sin(T), x = 2 * T / 3 - s + (s - s * s * s / 3) / 3;
  for (const char* other : {"y >= -x^6", "y >= -x^8", "2*y >= -x^10", "y >= -x^4"}) {
    CAPTURE(std::string(other));
    const Followed motion = followed({{"x", "y"},
                                      "(x'^2+y'^2)/2",
                                      "9.81*y",
                                      {},
                                      {},
                                      {{"x", "sin(t)^3"}},
                                      {{"floor", "y >= 0"}, {"other", other}}},
                                     state({0, 0}, {0, 0}), T);
    REQUIRE(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(x).epsilon(1e-10));
  }
}

TEST_CASE("floors that rounding does not tell from each other let go of a body at one time") {
  // Up to t0 the body is on a table at 0.1 sin 3t; x, below 1e-7, moves neither floor by more than rounding.
  const auto push = [](double t) { return 9.81 * std::cos(7 * t) - 0.9 * std::sin(3 * t); };
  double t0 = 0.2, late = 0.25;
  for (int k = 0; k < 60; ++k) (push((t0 + late) / 2) > 0 ? t0 : late) = (t0 + late) / 2;
  const double v = 0.3 * std::cos(3 * t0) - 9.81 / 7 * (std::sin(3.5) - std::sin(7 * t0));
  const Followed motion =
      followed({{"x", "y", "z"},
                "((1+x^2)*x'^2+y'^2+z'^2)/2",
                "",
                {},
                {},
                {{"x", "1e-6"}, {"y", "-9.81*cos(7*t)"}, {"z", "1"}},
                {{"dome", "y >= -x^4-x^2+0.1*sin(3*t)"}, {"bowl", "exp(y-(abs(x)^3+0.1*sin(3*t))) >= 1"}}},
               state({0, 0, 0}, {0, 0.3, 0}), 0.5);
  REQUIRE(motion.motion.status() == MotionStatus::done);
  CHECK(motion.end().v[1] == doctest::Approx(v).epsilon(1e-9));
  CHECK(std::abs(motion.end().v[0] - 5e-7) < 1e-7);
}

TEST_CASE("a floor from which another one parts as slowly as rounding tells lets a body move along it") {
  // x = 1e-6 t²/2, on a table that moves y alone.
  const Followed motion =
      followed({{"x", "y"},
                "(x'^2+y'^2)/2",
                "9.81*y",
                {},
                {},
                {{"x", "1e-6"}},
                {{"floor", "y >= 0.05*(1-cos(5*t))"}, {"other", "y >= cos(x)-1+0.05*(1-cos(5*t))"}}},
               state({0, 0}, {0, 0}), 2);
  REQUIRE(motion.motion.status() == MotionStatus::done);
  CHECK(motion.end().q[0] == doctest::Approx(2e-6).epsilon(1e-9));
  CHECK(motion.motion.record().steps < 50);
}

TEST_CASE("below a floor that holds, others that touch it to a high order at the start change nothing") {
  struct Case {
    std::vector<std::string> floors;  // the first one is above the others
    const char *force, *weight;
    double v;
  };
  const Case cases[] = {
      {{"2*x^2 + 0.1*x^8", "2*x^2"}, "-t^2", "y", -1e-9},
      {{"x^2 + 0.5*x^3", "x^2 + 0.5*x^3 - 0.5*x^6", "x^2 + 0.5*x^3 - 0.7*x^6"}, "sin(3*t)", "y", -1e-9},
      {{"0.5*x + x^2 + 0.1*x^8", "0.5*x + x^2"}, "t", "9.81*y", 1e-9},
      {{"0.5*x^3", "0.5*x^3 - x^2"}, "0", "9.81*y", 1e-9},
      {{"0.5*x + 0.3*x^2 + x^4", "0.5*x + 0.3*x^2", "0.5*x + 0.3*x^2 + 0.01*x^5"}, "-0.3*x", "9.81*y", 0},
      {{"-log(cos(x))", "log(1 + x^2/2)"}, "0.2*x", "9.81*y", -1e-3}};
  for (const Case& one : cases) {
    CAPTURE(one.floors[0]);
    SystemText text{{"x", "y"}, "(x'^2+y'^2)/2", one.weight, {}, {}, {{"x", one.force}}, {}};
    const double slope = one.floors[0].starts_with("0.5*x +") ? 0.5 : 0;
    const mechanics::State start = state({0, 0}, {one.v, slope * one.v});
    text.constraints = {{"a", "y >= " + one.floors[0]}};
    const Followed alone = followed(text, start, 1.7);
    for (std::size_t k = 1; k < one.floors.size(); ++k)
      text.constraints.emplace_back("b" + std::to_string(k), "y >= " + one.floors[k]);
    const Followed motion = followed(text, start, 1.7);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(alone.end().q[0]).epsilon(1e-9));
    CHECK(motion.end().v[0] == doctest::Approx(alone.end().v[0]).epsilon(1e-9));
    CHECK(motion.motion.record().steps < 200);
  }
}
