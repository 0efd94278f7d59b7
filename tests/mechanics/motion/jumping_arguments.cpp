// Arguments of branches that come to their other side otherwise than through a simple zero.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "mechanics/number_text.hpp"
#include "tests/mechanics/motion/followed.hpp"

using namespace tests;
using mechanics::MotionStatus;

namespace {

constexpr double last = 4;

/// A unit mass from x = 0.5 with the velocity -1.
Followed pushed(const std::string& force) { return tests::pushed(force, 0.5, -1, last); }

/// The same under a force of 1 at the times of (from, to), and those a period later.
mechanics::State pushed_between(double from, double to, double period) {
  mechanics::State end = state({0.5 - last}, {-1});
  for (double shift = 0; from + shift < last; shift += period) {
    const double on = from + shift, off = std::min(last, to + shift);
    end.v[0] += off - on;
    end.q[0] += (off - on) * (last - (on + off) / 2);
  }
  return end;
}

}  // namespace

TEST_CASE(
    "a distance from a point has its threshold on the far side too, where the path is straight through it") {
  const std::pair<const char*, const char*> same[] = {
      {"-max(0, hypot(x, 0) - 1)*x", "-max(0, abs(x) - 1)*x"},
      {"-max(0, sqrt(x^2) - 1)*x", "-max(0, abs(x) - 1)*x"},
      {"-max(0, sqrt(x^2 - 0.4*x + 0.04) - 1)*x", "-max(0, abs(x - 0.2) - 1)*x"},
      {"if(hypot(x, 0) > 1, -x, 0)", "if(abs(x) > 1, -x, 0)"},
      {"2 - x'*if(hypot(x', 0) > 0.5, 2, 0)", "2 - x'*if(abs(x') > 0.5, 2, 0)"}};
  for (const auto& [of_distance, of_size] : same) {
    CAPTURE(of_distance);
    const Followed told = pushed(of_distance), right = pushed(of_size);
    CHECK(told.motion.status() == MotionStatus::done);
    CHECK(told.end().q[0] == doctest::Approx(right.end().q[0]).epsilon(1e-10));
    CHECK(told.end().v[0] == doctest::Approx(right.end().v[0]).epsilon(1e-10));
  }
}

TEST_CASE("a slack rope holds a mass let go straight above its anchor") {
  const std::string pull = "-20*max(0, hypot(x, y) - 1)/hypot(x, y)";
  const Followed
      told = followed(
          {{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {{"x", pull + "*x"}, {"y", pull + "*y - 9.81"}}, {}},
          state({0, 0.5}, {0, 0}), last),
      right = followed({{"y"}, "y'^2/2", "", {}, {}, {{"y", "-20*max(0, abs(y) - 1)*sign(y) - 9.81"}}, {}},
                       state({0.5}, {0}), last);
  CHECK(told.motion.status() == MotionStatus::done);
  CHECK(told.end().q[1] == doctest::Approx(right.end().q[0]).epsilon(1e-10));
  CHECK(told.end().v[1] == doctest::Approx(right.end().v[0]).epsilon(1e-10));
}

TEST_CASE("a branch takes its side beyond a pole, and beyond the kink of a wave") {
  using std::numbers::pi;
  struct Wave {
    const char* force;
    double from, to, period;
  };
  const Wave waves[] = {{"if(1/(t - 1) > 2, 1, 0)", 1, 1.5, 10},
                        {"if(tan(3*t) > 1, 1, 0)", pi / 12, pi / 6, pi / 3},
                        {"(1 + sign(tan(3*t)))/2", 0, pi / 6, pi / 3},
                        {"if(asin(sin(3*t)) > 0.5, 1, 0)", 0.5 / 3, (pi - 0.5) / 3, 2 * pi / 3},
                        {"if(acos(cos(3*t)) > 1, 1, 0)", 1. / 3, (2 * pi - 1) / 3, 2 * pi / 3}};
  for (const Wave& wave : waves) {
    CAPTURE(wave.force);
    const Followed told = pushed(wave.force);
    const mechanics::State right = pushed_between(wave.from, wave.to, wave.period);
    CHECK(told.motion.status() == MotionStatus::done);
    CHECK(told.end().q[0] == doctest::Approx(right.q[0]).epsilon(1e-10));
    CHECK(told.end().v[0] == doctest::Approx(right.v[0]).epsilon(1e-10));
  }
}

TEST_CASE("an argument with a zero of higher order changes its sign where it has it") {
  for (const char* power : {"3", "5", "7", "9"}) {
    CAPTURE(power);
    const Followed told = pushed("sign((t - 1)^" + std::string(power) + ")");
    CHECK(told.end().q[0] == doctest::Approx(-2.5).epsilon(1e-9));
    CHECK(told.end().v[0] == doctest::Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("friction by a root of v'v turns in milliseconds as it does in seconds") {
  for (const double unit : {1.0, 1e-3, 1e-6}) {
    CAPTURE(unit);
    const std::string u = mechanics::number_text(unit), v = "hypot(x'*" + u + ", 0)";
    const Followed told =
        followed({{"x"},
                  "x'^2/2",
                  "",
                  {},
                  {},
                  {{"x", "(2 - tanh(" + v + "/0.01)*x'*" + u + "/max(" + v + ", 1e-3))/" + u + "^2"}},
                  {}},
                 state({0.5}, {-1 / unit}), 2 * unit);
    CHECK(told.motion.status() == MotionStatus::done);
    CHECK(told.end().q[0] == doctest::Approx(1.7282954).epsilon(1e-7));  // by DOP853, in seconds
    CHECK(told.end().v[0] * unit == doctest::Approx(1.6703290).epsilon(1e-7));
  }
}

TEST_CASE("bodies a nanometre apart that move for a quarter of an hour come to an end") {
  const SystemText text{
      {"x", "y"},
      "(x'^2 + y'^2)/2",
      "",
      {},
      {},
      {{"x", "(sin(0.015*t) - 2 + 10*((y - x)*1e9 - 0.5))*1e-15"}, {"y", "-10*((y - x)*1e9 - 0.5)*1e-15"}},
      {{"wall", "x >= (0.1*sin(0.004*t) - 0.1)*1e-9"}, {"gap", "y - x >= 2e-10"}}};
  const Followed told = followed(text, state({1e-10, 4e-10}, {0, 2e-12}), 1000, restitution(text, 0.3));
  CHECK(told.motion.status() == MotionStatus::done);
}

TEST_CASE("the size of what is no less than 0 is itself where it touches 0") {
  const auto band = [](const std::string& size) {
    return followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "-1 - if(" + size + " < 0.1, x, 0)"}}, {}},
                    state({1}, {1}), last);
  };
  const Followed told = band("abs(abs(x')^1.5)"), right = band("abs(x')^1.5");
  CHECK(told.end().q[0] == doctest::Approx(right.end().q[0]).epsilon(1e-10));
  CHECK(told.end().v[0] == doctest::Approx(right.end().v[0]).epsilon(1e-10));
}

TEST_CASE("what has more zeros at once than a series has orders is met all the same") {
  const Followed told = pushed("if((t/2)^40 > 1, 1, 0)");
  CHECK(told.end().q[0] == doctest::Approx(-1.5).epsilon(1e-12));
  CHECK(told.end().v[0] == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("a ball strikes a bump of high order, and the humps of a fractional power") {
  const std::pair<const char*, double> bumps[] = {{"y >= 0.3*sin(3.14159*x/3)^40", 0.2},
                                                  {"y >= 0.3*abs(sin(3*x)*(x - 1))^2.5", 0.1}};
  for (const auto& [bump, height] : bumps) {
    CAPTURE(bump);
    const SystemText text{{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"bump", bump}}};
    const Followed told = followed(text, state({0, height}, {1, 0}), 3, restitution(text, 1));
    CHECK(told.motion.status() == MotionStatus::done);
    CHECK(told.motion.record().impacts > 0);
    CHECK(told.motion.record().largest_penetration < 1e-12);
    CHECK(told.motion.energy() == doctest::Approx(0.5).epsilon(1e-12));
  }
}

TEST_CASE("a pulse pushes a body at rest from the edge of its stop, however slowly it begins") {
  struct Stop {
    const char* stiffness;
    double x, v;  // at t = 2, by DOP853 (Hairer, Norsett and Wanner 1993) with steps of 2e-4
  };
  for (const Stop& stop : {Stop{"10", 0.53116586, -0.05467704}, Stop{"10000", 0.4486405, -0.05374742}}) {
    CAPTURE(stop.stiffness);
    const std::string force =
        "-max(x - 0.5, 0)*" + std::string(stop.stiffness) + " + 5*exp(-((t - 1)/0.02)^2)";
    const Followed told = followed({{"x"}, "x'^2", "", {}, {}, {{"x", force}}, {}}, state({0.5}, {0}), 2);
    CHECK(told.motion.status() == MotionStatus::done);
    CHECK(told.end().q[0] == doctest::Approx(stop.x).epsilon(1e-7));
    CHECK(told.end().v[0] == doctest::Approx(stop.v).epsilon(1e-6));
  }
}

TEST_CASE("a force with a pole between two branches ends the motion, one that is cut off there does not") {
  for (const char* force :
       {"max(0, 1/(t - 0.3))", "max(-1, 1/(t - 0.3))", "abs(tan(t))", "max(0, tan(t + 1))"}) {
    CAPTURE(force);
    CHECK(pushed(force).motion.status() == MotionStatus::stopped);
  }
  // x'' = -5 x s(t) with s cut off at ±1; by DOP853 between the times at which tan(3 t) is ±1 or has its
  // pole.
  const Followed told = pushed("-5*x*max(-1, min(1, tan(3*t)))");
  CHECK(told.motion.status() == MotionStatus::done);
  CHECK(told.end().q[0] == doctest::Approx(-1.65801056).epsilon(1e-8));
  CHECK(told.end().v[0] == doctest::Approx(0.20565817).epsilon(1e-7));
  for (std::size_t k = 1; k < told.events.size(); ++k)
    if (told.events[k].t == told.events[k - 1].t)
      CHECK(told.events[k].velocity_before == told.events[k - 1].velocity_after);
}

TEST_CASE("a ball bounces on a floor that moves with a late time as with an early one") {
  const auto bounced = [](double start) {
    const std::string t = "(t - " + mechanics::number_text(start) + ")";
    const SystemText text{
        {"x"}, "x'^2/2", "", {}, {}, {{"x", "-9.81"}}, {{"floor", "x >= 0.05*sin(8*" + t + ")"}}};
    return followed(text, {start, mechanics::Vector{{0.3}}, mechanics::Vector{{0}}}, start + 2,
                    restitution(text, 0.5));
  };
  const Followed soon = bounced(0), late = bounced(1e6);
  CHECK(late.motion.status() == MotionStatus::done);
  CHECK(late.end().q[0] == doctest::Approx(soon.end().q[0]).epsilon(1e-7));
}

TEST_CASE("a motion that comes to infinity is told as it was there, and not beyond a jump") {
  const Followed told =
      followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "-x - 20*max(0, (x*x')^3)"}}, {}}, state({1}, {-1}), 2);
  CHECK(told.motion.status() == MotionStatus::stopped);
  CHECK(std::abs(told.end().q[0]) < 1);
  CHECK(told.end().v[0] < -1e3);
}

TEST_CASE("an angle that the arctangent wraps jumps at each pole of the tangent, and a branch with it") {
  // x'' = 0.6 where 3x - 1 is within (0.7, pi/2) up to a multiple of pi, else 0.15: v²/2 is the work done.
  const double pi = std::acos(-1.0), start = 0.20083633820444735, v = 0.3;
  for (const double until : {2.0, 4.0, 6.0}) {
    CAPTURE(until);
    const Followed motion = followed(
        {{"x"}, "x'^2/2", "", {}, {}, {{"x", "0.3*if(atan(tan(3*x - 1)) > 0.7, 1, -0.5) + 0.3"}}, {}},
        state({start}, {v}), until);
    REQUIRE(motion.motion.status() == MotionStatus::done);
    const double x = motion.end().q[0], speed = motion.end().v[0];
    double inside = 0;
    for (int n = 0; n < 10; ++n)
      inside += std::max(0.0, std::min(x, (1 + pi / 2 + n * pi) / 3) - (1.7 + n * pi) / 3);
    CHECK(std::abs(speed * speed / 2 - v * v / 2 - 0.15 * (x - start) - 0.45 * inside) <= 1e-10);
  }
}
