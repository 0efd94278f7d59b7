#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

/// x'' = -x with a stop.
SystemText oscillator(const std::string& stop) {
  return {{"x"}, "x'^2/2", "x^2/2", {}, {}, {}, {{"stop", stop}}};
}

}  // namespace

TEST_CASE("a pendulum keeps its energy and its period, and the error falls with the tolerance") {
  const SystemText text{{"a"}, "a'^2/2", "-9.81*cos(a)", {}, {}, {}, {}};
  // 4 K(sin(1/2)) / sqrt(9.81), the complete elliptic integral by 30 digits.
  const double period = 2.139137600558689;
  double last = 1;
  for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
    MotionOptions options;
    options.tolerance = tolerance;
    const Followed found = followed(text, state({1}, {0}), period, options);
    const double error = std::abs(found.end().q[0] - 1) + std::abs(found.end().v[0]);
    CHECK(error <= std::max(0.1 * last, 2e-14));
    CHECK(std::abs(found.motion.energy() + 9.81 * std::cos(1.0)) <= std::max(10 * tolerance, 1e-14));
    last = error;
  }
  CHECK(last <= 2e-14);
}

TEST_CASE("dense output satisfies the equations between the ends of steps") {
  const SystemText text{
      {"a", "b"}, "a'^2 + b'^2/2 + a'*b'*cos(a - b)", "-9.81*(2*cos(a) + cos(b))", {}, {}, {}, {}};
  const auto made = system(text);
  Motion motion(*made, state({2, -1}, {0, 3}));
  while (motion.advance(3.0)) {
    const Arc& arc = motion.arc();
    for (const double part : {0.3, 0.8}) {
      const State s = arc.state(part * arc.length);
      const Inertia inertia = made->inertia(s);
      const Vector missing = inertia.A * arc.acceleration(part * arc.length) - inertia.z;
      CHECK(missing.norm() <= 1e-11 * inertia.z.norm());
    }
  }
  CHECK(motion.energy() == doctest::Approx(made->energy(state({2, -1}, {0, 3}))).epsilon(1e-13));
}

TEST_CASE("rods hold to the last digit over a long motion") {
  const SystemText text{{"x", "y", "u", "v"},
                        "(x'^2 + y'^2)/2 + u'^2 + v'^2",
                        "9.81*(y + 2*v)",
                        {},
                        {},
                        {},
                        {{"first", "x^2 + y^2 = 1"}, {"second", "(u - x)^2 + (v - y)^2 = 4"}}};
  const Followed found = followed(text, state({1, 0, 1, 2}, {0, 1, 0, 1}), 100);
  CHECK(found.motion.status() == MotionStatus::done);
  CHECK(found.motion.record().largest_penetration <= 2e-14);
  const auto rates = found.system->constraint_rates(found.end());
  CHECK(rates.f.cwiseAbs().maxCoeff() <= 4e-15);
  CHECK(rates.df.cwiseAbs().maxCoeff() <= 1e-13);
  const double energy = found.system->energy(state({1, 0, 1, 2}, {0, 1, 0, 1}));
  CHECK(found.motion.energy() == doctest::Approx(energy).epsilon(1e-12));
}

TEST_CASE("an oscillator strikes its stop at the times of its circle functions") {
  // From x = 0, v = 1 to the stop at sin t = 0.5; back with speed e sqrt(3)/2, and so on.
  const double e = 0.8;
  const Followed found =
      followed(oscillator("x <= 0.5"), state({0}, {1}), 20, restitution(oscillator(""), e));
  double t = std::asin(0.5), v = std::sqrt(0.75);
  REQUIRE(found.events.size() > 2);
  for (const MotionEvent& event : found.events) {
    if (event.kind != EventKind::impact) break;
    CHECK(std::abs(event.t - t) <= 1e-13);
    CHECK(std::abs(event.velocity_before[0] - v) <= 1e-13);
    // x = 0.5 cos τ - e v sin τ: back at 0.5 when tan(τ/2) = -2 e v, τ in (0, 2π).
    t += 2 * (std::acos(-1.0) - std::atan(2 * e * v));
    v *= e;
  }
}

TEST_CASE(
    "a stop that is just touched is a contact, one beyond reach is nothing, two roots in a step an impact") {
  const Followed touch = followed(oscillator("x <= 1"), state({0}, {1}), 3, restitution(oscillator(""), 0.5));
  REQUIRE(touch.events.size() == 1);
  CHECK(touch.events[0].kind == EventKind::contact);
  CHECK(touch.events[0].t == doctest::Approx(std::acos(0.0)).epsilon(1e-7));
  CHECK(touch.motion.record().remarks.size() == 1);
  CHECK(touch.end().q[0] == doctest::Approx(std::sin(3.0)).epsilon(1e-13));
  CHECK(followed(oscillator("x <= 1"), state({0}, {1 - 1e-10}), 3).events.empty());
  // Beyond the stop by 5e-11 only: the two roots are 2e-5 apart.
  const Followed strike = followed(oscillator("x <= 1"), state({0}, {1 + 5e-11}), 3);
  REQUIRE(!strike.events.empty());
  CHECK(strike.events[0].kind == EventKind::impact);
  CHECK(strike.events[0].t == doctest::Approx(std::acos(0.0) - 1e-5).epsilon(1e-9));
}

TEST_CASE("walls struck at one instant are one event") {
  const SystemText text{
      {"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"right", "x <= 1"}, {"top", "y <= 1"}}};
  const Followed found = followed(text, state({0.1, 0.1}, {0.3, 0.3}), 5, restitution(text, 1));
  REQUIRE(found.events.size() == 1);
  CHECK(found.events[0].constraints == std::vector<Index>{0, 1});
  CHECK(found.motion.record().impacts == 1);
}

TEST_CASE("a branch of |x| is an event, and the motion beyond is that of the other branch") {
  const SystemText text{{"x"}, "x'^2/2", "", {}, {}, {{"x", "-abs(x')*x'"}}, {}};
  const Followed braked = followed(text, state({0}, {2}), 5);
  CHECK(braked.events.empty());
  CHECK(braked.end().q[0] == doctest::Approx(std::log(11.0)).epsilon(1e-13));
  // -|x| pulls to the left: x'' = -x, then x'' = x.
  const SystemText pull{{"x"}, "x'^2/2", "", {}, {}, {{"x", "-abs(x)"}}, {}};
  const Followed found = followed(pull, state({1}, {0}), 2);
  REQUIRE(found.events.size() == 1);
  CHECK(found.events[0].kind == EventKind::branch);
  CHECK(found.events[0].t == doctest::Approx(std::acos(0.0)).epsilon(1e-14));
  CHECK(found.end().q[0] == doctest::Approx(-std::sinh(2 - std::acos(0.0))).epsilon(1e-13));
}

TEST_CASE("a motion that cannot go on keeps what it has: a force without value, dry friction, a limit") {
  const SystemText dry{{"x"}, "x'^2/2", "", {}, {}, {{"x", "-2*x'/abs(x')"}}, {}};
  const Followed friction = followed(dry, state({1}, {3}), 20);
  CHECK(friction.motion.status() == MotionStatus::stopped);
  CHECK(friction.end().t == doctest::Approx(1.5).epsilon(1e-12));
  CHECK(friction.end().q[0] == doctest::Approx(3.25).epsilon(1e-12));
  CHECK(friction.motion.why().find("1.5") != std::string::npos);

  const SystemText edge{{"x"}, "x'^2/2", "", {}, {}, {{"x", "sqrt(1 - x)"}}, {}};
  const Followed fall = followed(edge, state({0}, {1}), 20);
  CHECK(fall.motion.status() == MotionStatus::stopped);
  CHECK(fall.end().q[0] == doctest::Approx(1).epsilon(1e-6));

  MotionOptions few;
  few.step_limit = 3;
  few.restitution = Vector{{0.9}};
  const Followed limited = followed(ball(), state({1}, {0}), 20, few);
  CHECK(limited.motion.status() == MotionStatus::stopped);
  CHECK(limited.motion.why().find("limit") != std::string::npos);
  CHECK(limited.events.size() == 3);
}

TEST_CASE("a force whose series is 0 for thirty orders is not taken for none") {
  const SystemText text{{"x"}, "x'^2/2", "", {}, {}, {{"x", "t^30"}}, {}};
  const Followed found = followed(text, state({0}, {0}), 1);
  CHECK(found.end().q[0] == doctest::Approx(1.0 / (31 * 32)).epsilon(1e-12));
}

TEST_CASE("two touches within one step are two events, and no impact") {
  // y = (t - 1)² (t - 2)², a polynomial: one step goes over both.
  const SystemText text{{"y"}, "y'^2/2", "", {}, {}, {{"y", "12*t^2 - 36*t + 26"}}, {{"floor", "y >= 0"}}};
  const Followed found = followed(text, state({4}, {-12}), 3, restitution(text, 0.5));
  REQUIRE(found.events.size() == 2);
  for (const int k : {0, 1}) {
    CHECK(found.events[static_cast<std::size_t>(k)].kind == EventKind::contact);
    CHECK(found.events[static_cast<std::size_t>(k)].t == doctest::Approx(1 + k).epsilon(1e-14));
  }
  CHECK(found.end().q[0] == doctest::Approx(4).epsilon(1e-13));
}

TEST_CASE(
    "a body dropped from rest falls through air whose drag is |v| v, in as many coordinates as it has") {
  // The second derivative of |v| v at v = 0 is not defined; v = -v_t tanh(g t/v_t), v_t = √(g/k).
  const double g = 9.81, k = 0.1, limit = std::sqrt(g / k), t = 2;
  for (const char* speed : {"sqrt(x'^2 + y'^2)", "hypot(x', y')", "norm([x', y', 0])"}) {
    CAPTURE(std::string(speed));
    const std::string drag = "-0.1*" + std::string(speed);
    const Followed motion = followed(
        {{"x", "y"}, "(x'^2 + y'^2)/2", "9.81*y", {}, {}, {{"x", drag + "*x'"}, {"y", drag + "*y'"}}, {}},
        state({0, 0}, {0, 0}), t);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[1] == doctest::Approx(-std::log(std::cosh(g * t / limit)) / k).epsilon(1e-12));
    CHECK(motion.end().v[1] == doctest::Approx(-limit * std::tanh(g * t / limit)).epsilon(1e-12));
    CHECK(motion.motion.record().steps < 50);
  }
}

TEST_CASE(
    "where a force has no derivative at the start a motion that moves goes on, and one at rest is refused") {
  const auto along = [](const std::string& force, double v) { return pushed(force, 0, v, 0.5); };
  // ½ v² - ⅔ x^1.5 = ½ by the energy; the rest of x'' = √x is one of many motions from there.
  const Followed moving = along("sqrt(x)", 1);
  CHECK(moving.motion.status() == MotionStatus::done);
  const double x = moving.end().q[0], v = moving.end().v[0];
  CHECK(v * v / 2 - 2 * std::pow(x, 1.5) / 3 == doctest::Approx(0.5).epsilon(1e-10));
  CHECK_THROWS_WITH_AS(along("sqrt(x)", 0), doctest::Contains("order 3 is not finite"), convex::InvalidInput);
  CHECK_THROWS_WITH_AS(followed({{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"x", "sqrt(x)"}, {"y", "1"}}, {}},
                                state({0, 0}, {0, 0}), 1),
                       doctest::Contains("order 3 is not finite"), convex::InvalidInput);
  CHECK(along("-x'*hypot(x', 0)", 0).end().q[0] == 0);  // drag leaves a rest alone
}

TEST_CASE("branches at 0 go on by themselves where another force has no second derivative at the start") {
  // y' = 1 - e^(-t) by the drag of y alone; a body hung from rest on a spring, and one thrown up, by DOP853.
  struct Case {
    const char *x, *y;
    mechanics::State start;
    double until, q;
    int which;
  };
  const Case cases[] = {
      {"1 - hypot(x', 0)*x'", "1 - max(y', 0)", state({0, 0}, {0, 0}), 3, 2 + std::exp(-3), 1},
      {"-9.81 - hypot(x', y')*x' + 50*max(-x, 0)", "-hypot(x', y')*y'", state({0, 0}, {0, 0}), 4,
       -0.254549543285, 0},
      {"-9.81 - hypot(x', y')*x' - sign(x')", "-hypot(x', y')*y'", state({0, 0}, {5, 0}), 2, -3.75140449696,
       0}};
  for (const Case& one : cases) {
    CAPTURE(std::string(one.x));
    const Followed motion = followed(
        {{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"x", one.x}, {"y", one.y}}, {}}, one.start, one.until);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[one.which] == doctest::Approx(one.q).epsilon(1e-9));
  }
}
