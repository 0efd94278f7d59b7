#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "mechanics/motion/leaving_zero.hpp"
#include "tests/mechanics/motion/followed.hpp"

/// Arguments of branches, and multipliers, that are 0 at the start or for a while.
using namespace tests;
using mechanics::MotionStatus;

TEST_CASE("a double zero of an argument changes nothing, however near to it rounding lets the motion come") {
  struct Case {
    std::string force, smooth;
    double x;
  };
  const Case cases[] = {{"sign(x'^2) - x", "1 - x", -1},
                        {"step(-x'^2) - x", "-x", -1},
                        {"sign(x'^2*(x - 9)^2) - 2*x", "1 - 2*x", 0.3},
                        {"sign(sin(x')^2) - 2*x", "1 - 2*x", 0.3},
                        {"atan2(x'^2, x - 5) - 2*x", "atan2(x'^2 + 1e-300, x - 5) - 2*x", -1}};
  for (const Case& one : cases) {
    CAPTURE(one.force);
    const Followed motion = pushed(one.force, one.x, 0, 20), smooth = pushed(one.smooth, one.x, 0, 20);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(smooth.end().q[0]).epsilon(1e-10));
    CHECK(motion.end().v[0] == doctest::Approx(smooth.end().v[0]).epsilon(1e-10));
  }
}

TEST_CASE("an argument too small for a double counts again where it is one") {
  struct Case {
    std::string force, smooth;
    double x, v, until;
  };
  const Case cases[] = {{"100*max(exp(-(x - 30)^2), 0)", "100*exp(-(x - 30)^2)", 0, 5, 12},
                        {"100*abs(exp(-x^2))", "100*exp(-x^2)", 30, -5, 12},
                        {"if(exp(-x^2) > 0, 100*exp(-x^2), 0)", "100*exp(-x^2)", 30, -5, 12},
                        {"max(exp(-x), 0)", "exp(-x)", 800, -100, 12},
                        {"100*max(exp(-(t - 30)^2), 0)", "100*exp(-(t - 30)^2)", 0, 0, 40}};
  for (const Case& one : cases) {
    CAPTURE(one.force);
    const Followed motion = pushed(one.force, one.x, one.v, one.until),
                   smooth = pushed(one.smooth, one.x, one.v, one.until);
    CHECK(motion.end().q[0] == doctest::Approx(smooth.end().q[0]).epsilon(1e-11));
    CHECK(motion.end().v[0] == doctest::Approx(smooth.end().v[0]).epsilon(1e-11));
  }
}

TEST_CASE("a body at rest feels its drag and its springs once a pulse has come") {
  struct Case {
    std::string force;
    double until, x;  // x by DOP853 (Hairer, Norsett and Wanner 1993) with 8000 steps
  };
  const Case cases[] = {{"10*exp(-50*(t - 4)^2) - x - 3*abs(x')*x'", 8, -0.0950278040},
                        {"10*exp(-50*(t - 4)^2) - x - max(5*x, 0)", 8, -1.00108860846},
                        {"10*exp(-50*(t - 4)^2) - x - if(x > 0, 5*x, 0)", 8, -1.00108860846},
                        {"10*exp(-(t - 30)^2) - x - 3*abs(x')*x'", 40, 0.00542148201}};
  for (const Case& one : cases) {
    CAPTURE(one.force);
    CHECK(pushed(one.force, 0, 0, one.until).end().q[0] == doctest::Approx(one.x).epsilon(1e-9));
  }
}

TEST_CASE("what leaves 0 by a power beyond all derivatives has left it") {
  // x'' = t⁴⁰ is x = t⁴²/1722.
  CHECK(pushed("3*sign(x) + t^40", 0, 0, 2).end().q[0] ==
        doctest::Approx(std::pow(2, 42) / 1722 + 6).epsilon(1e-12));
  CHECK(pushed("2*abs(x) + t^40", 0, 0, 2).end().q[0] ==
        doctest::Approx(pushed("2*x + t^40", 0, 0, 2).end().q[0]).epsilon(1e-12));
  const Followed lifted =
      followed({{"y"}, "y'^2/2", "", {}, {}, {{"y", "t^40"}}, {{"floor", "y >= 0"}}}, state({0}, {0}), 2);
  CHECK(lifted.end().q[0] == doctest::Approx(std::pow(2, 42) / 1722).epsilon(1e-12));
  CHECK(lifted.motion.multipliers()[0] == 0);
}

TEST_CASE("a body at rest under forces that cancel but for rounding waits for what comes") {
  // ∫ (6 - t) (1 + tanh(10 (t - 3))) dt, and tanh(-30) = -1 in doubles.
  const Followed switched = pushed("1 + tanh(10*(t - 3))", 0, 0, 6);
  CHECK(switched.end().q[0] == doctest::Approx(9 + std::pow(std::acos(-1), 2) / 1200).epsilon(1e-12));
  CHECK(switched.end().v[0] == doctest::Approx(6).epsilon(1e-12));
  const Followed still = pushed("cos(t)^2 + sin(t)^2 - 1 - x", 0, 0, 6);
  CHECK(still.motion.status() == MotionStatus::done);
  CHECK(std::abs(still.end().q[0]) <= 1e-12);
  CHECK(still.motion.record().steps < 100);
}

TEST_CASE("a motion that begins on a kink of a contact begins on the side to which its velocity leads") {
  struct Case {
    const char* floor;
    mechanics::State start;
    double x, y;  // at t = 0.1, by hand: x'' and y'' are those of a slope under the weight 1
  };
  const mechanics::State roof = state({0, 0}, {-1, 0}), edge = state({0, 0}, {1, -1});
  const mechanics::State slope = state({0, 0}, {1, 0.5}), groove = state({0.25, 0}, {-0.5, 0.5});
  const Case cases[] = {{"y >= min(0, -x)", roof, -0.1, 0},
                        {"y >= min(-x, 0)", roof, -0.1, 0},
                        {"y >= if(x > 0, -x, 0)", edge, 0.1025, -0.1025},
                        {"y >= if(x >= 0, -x, 0)", edge, 0.1025, -0.1025},
                        {"y >= min(3*x, 0.5*x)", slope, 0.098, 0.049},
                        {"y >= min(0.5*x, 3*x)", slope, 0.098, 0.049},
                        {"y >= max(-0.5*x + 0.125, -x + 0.25)", groove, 0.2025, 0.0475},
                        {"y >= max(-x + 0.25, -0.5*x + 0.125)", groove, 0.2025, 0.0475}};
  for (const Case& one : cases) {
    CAPTURE(std::string(one.floor));
    const Followed motion =
        followed({{"x", "y"}, "(x'^2+y'^2)/2", "y", {}, {}, {}, {{"floor", one.floor}}}, one.start, 0.1);
    CHECK(motion.motion.record().impacts == 0);
    CHECK(motion.end().q[0] == doctest::Approx(one.x).epsilon(1e-12));
    CHECK(motion.end().q[1] == doctest::Approx(one.y).epsilon(1e-12));
  }
}

TEST_CASE(
    "a piston that grazes its plate at each dead centre is not struck by what rounding leaves of that") {
  // Written with the rod as a constraint, and with the piston's place as a function of the angle.
  const SystemText rod{{"a", "x"},
                       "0.01*a'^2 + 0.4*x'^2",
                       "",
                       {},
                       {},
                       {{"x", "-400"}, {"a", "3"}},
                       {{"rod", "(x - 0.05*cos(a))^2 + (0.05*sin(a))^2 = 0.04"}, {"plate", "x <= 0.25"}}};
  const std::string place = "(0.05*cos(a) + sqrt(0.04 - (0.05*sin(a))^2))";
  const SystemText angle{{"a"}, "0.01*a'^2 + 0.4*x'^2",  "400*x - 3*a", {}, {{"x", place}},
                         {},    {{"plate", "x <= 0.25"}}};
  for (const double speed : {15, 16, 18, 19, 20, 22, 23}) {
    CAPTURE(speed);
    const Followed by_rod = followed(rod, state({0, 0.25}, {speed, 0}), 1),
                   by_angle = followed(angle, state({0}, {speed}), 1);
    CHECK(by_rod.motion.status() == MotionStatus::done);
    CHECK(by_rod.motion.record().impacts == 0);
    CHECK(by_angle.motion.record().impacts == 0);
    CHECK(by_rod.end().v[0] == doctest::Approx(by_angle.end().v[0]).epsilon(1e-11));
  }
}

TEST_CASE(
    "a body that comes to rest at the bottom of a kink stays, whatever rounding leaves of its velocity") {
  for (const char* kink : {"sign(x)", "sign(sin(3*x))"}) {
    CAPTURE(std::string(kink));
    const Followed motion = pushed("if(t < 1, -2, -" + std::string(kink) + " - 0.5*x)", -1, 2, 1.5);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(std::abs(motion.end().q[0]) <= 1e-14);
    CHECK(motion.motion.record().steps < 20);
  }
}

TEST_CASE("a body that friction alone slows down comes to rest, whatever rounding leaves of its velocity") {
  for (const double v : {0.05, 0.1, 0.3, 1.0, 2.0, 3.0})
    for (const char* force : {"-0.3*sign(x') - 0.2*x'", "-(0.5 + 0.5*exp(-(x'/0.1)^2))*sign(x')",
                              "-0.3*tanh(x'/0.01) - 0.1*sign(x')"}) {
      CAPTURE(v);
      CAPTURE(force);
      const Followed motion = pushed(force, 0, v, 20), later = pushed(force, 0, v, 40);
      CHECK(motion.motion.status() == MotionStatus::done);
      CHECK(std::abs(motion.end().v[0]) < 1e-14);
      CHECK(later.end().q[0] == doctest::Approx(motion.end().q[0]).epsilon(1e-14));
    }
  const double rest = 1 / 0.2 - 0.3 / 0.04 * std::log(1 + 0.2 / 0.3);  // of x'' = -0.3 - 0.2 x' from 1
  CHECK(pushed("-0.3*sign(x') - 0.2*x'", 0, 1, 20).end().q[0] == doctest::Approx(rest).epsilon(1e-12));
}

TEST_CASE("a condition that is never below 0 holds beyond a zero of whatever order") {
  // x'' = -1 from x' = 1: x' comes to -0.3 at t = 1.3.
  for (const char* size : {"(x' + 0.3)^2", "sqrt(1 + (x' + 0.3)^4) - 1", "cosh((x' + 0.3)^2) - 1",
                           "exp((x' + 0.3)^4) - 1", "hypot(1, (x' + 0.3)^3) - 1", "(x' + 0.3)^6"}) {
    CAPTURE(size);
    const Followed motion = followed(
        {{"x"}, "x'^2/2", "", {}, {}, {{"x", "-step(" + std::string(size) + ")"}}, {}}, state({0}, {1}), 2);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(0).epsilon(1e-12));
    CHECK(motion.end().v[0] == doctest::Approx(-1).epsilon(1e-12));
  }
}

TEST_CASE("a sum of powers leaves 0 with the sign that it has where it is first so far from it") {
  struct Case {
    std::vector<double> c;
    double farthest;
  };
  const Case cases[] = {{{0, 0, 0, 0, 0, -0.0059, 0.5}, 1.2e-12},
                        {{0, -1e-6, 0, 1}, 1e-12},
                        {{0, -1e-6, 0, 1}, 1e-8},
                        {{0, 1, -1e8}, 1e-12},
                        {{0, 1, -1e8}, 1e-7},
                        {{0, 0, 2, -3e3, 1e6}, 1e-5}};
  for (const auto& [c, farthest] : cases) {
    CAPTURE(c.size());
    CAPTURE(farthest);
    const auto sum = [&c = c](double tau) {
      double found = 0;
      for (std::size_t k = 0; k < c.size(); ++k) found += c[k] * std::pow(tau, k);
      return found;
    };
    double tau = 1e-14;
    while (std::abs(sum(tau)) < farthest) tau *= 1 + 1e-4;
    std::size_t first = 1;
    while (c[first] == 0) ++first;
    const mechanics::LeavingTerm found =
        mechanics::leaving_term(c, std::vector<double>(c.size()), first, farthest);
    CHECK(c[found.order] * sum(tau) > 0);
    CHECK(found.at == doctest::Approx(tau).epsilon(0.3));
  }
}

TEST_CASE(
    "a body that comes back to its floor with the velocity 0 where its spring has a kink leaves again") {
  for (const char* spring : {"100*max(x, 0)", "if(x > 0, 100*x, 0)", "100*abs(x)", "100*x"}) {
    CAPTURE(spring);
    const Followed motion = followed(
        {{"x"}, "x'^2/2", "", {}, {}, {{"x", "0.2 - " + std::string(spring)}}, {{"floor", "x >= 0"}}},
        state({0}, {0}), 2);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(0.002 * (1 - std::cos(20.0))).epsilon(1e-10));
    CHECK(motion.end().v[0] == doctest::Approx(0.02 * std::sin(20.0)).epsilon(1e-10));
  }
}
