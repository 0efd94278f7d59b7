#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "tests/mechanics/motion/followed.hpp"

/// Roots and powers that are no whole ones, of what comes to 0 on the way: springs of Hertz, drag, cusps.
using namespace tests;
using mechanics::MotionStatus;

namespace {

/// ∫_a^b f by Simpson's rule on w with v = w².
double integral_of_squares(double a, double b, const std::function<double(double)>& f) {
  constexpr int parts = 20000;
  const double from = std::sqrt(a), h = (std::sqrt(b) - from) / parts;
  const auto g = [&](double w) { return 2 * w * f(w * w); };
  double sum = g(from) + g(from + parts * h);
  for (int i = 1; i < parts; ++i) sum += (i % 2 == 1 ? 4 : 2) * g(from + i * h);
  return sum * h / 3;
}

}  // namespace

TEST_CASE("a ball leaves a spring of Hertz after the time that he found, however the spring is written") {
  // x'' = k max(-x, 0)^(3/2) from x = 1 with the velocity -v: contact lasts 2.9432 δ/v, δ the largest
  // indentation (Hertz 1882; Johnson 1985, equation 11.24).
  constexpr double k = 1e4, v = 1, until = 3;
  const double indentation = std::pow(1.25 * v * v / k, 0.4);
  const double contact =
      2 * std::sqrt(std::numbers::pi) * std::tgamma(1.4) / std::tgamma(0.9) * indentation / v;
  for (const char* force : {"1e4*max(-x, 0)^1.5", "1e4*max(0, -x)^1.5", "1e4*abs(min(x, 0))^1.5",
                            "if(x < 0, 1e4*(-x)^1.5, 0)", "1e4*max(-x, 0)*sqrt(max(-x, 0))"}) {
    CAPTURE(force);
    const Followed motion = pushed(force, 1, -v, until);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().v[0] == doctest::Approx(v).epsilon(1e-10));
    CHECK(motion.end().q[0] == doctest::Approx(v * (until - 1 / v - contact)).epsilon(1e-9));
  }
}

TEST_CASE("a ball that falls from a spring of Hertz comes back to it, with the velocity 0 and otherwise") {
  for (const double v : {0.0, 1.0, -2.0, 3.0}) {
    CAPTURE(v);
    const Followed motion = pushed("1e4*max(-x, 0)^1.5 - 9.81", v == 0 ? 0 : 0.5, v, 20);
    REQUIRE(motion.motion.status() == MotionStatus::done);
    const double x = motion.end().q[0], speed = motion.end().v[0];
    const double energy = speed * speed / 2 + 9.81 * x + 0.4e4 * std::pow(std::max(-x, 0.0), 2.5);
    const double at_start = v * v / 2 + (v == 0 ? 0 : 9.81 * 0.5);
    CHECK(std::abs(energy - at_start) < 1e-8);
    if (v != 0) CHECK(motion.events.size() > 20);  // else it is never above the spring
  }
}

TEST_CASE(
    "a drag by a fractional power of the speed lets the motion turn, at the time that its integral tells") {
  // x'' = -|x'|^p sign(x') - g: v goes up from 0 in ∫ dv/(g + v^p), and down to -w in ∫ dv/(g - v^p).
  constexpr double g = 9.81;
  for (const double power : {0.5, 0.8, 1.2, 1.5, 2.5})
    for (const double v : {1.0, 3.0, 0.3}) {
      CAPTURE(power);
      CAPTURE(v);
      const double up = integral_of_squares(0, v, [&](double u) { return 1 / (g + std::pow(u, power)); });
      const std::string p = std::to_string(power);
      const Followed motion = pushed("-abs(x')^" + p + "*sign(x') - 9.81", 0.3, v, up + 0.2);
      REQUIRE(motion.motion.status() == MotionStatus::done);
      const double down = -motion.end().v[0];
      CHECK(down > 0);
      CHECK(integral_of_squares(0, down, [&](double u) { return 1 / (g - std::pow(u, power)); }) ==
            doctest::Approx(0.2).epsilon(1e-9));
    }
}

TEST_CASE("a motion straight through the tip of a cone in V is that over the roof of |x|") {
  const auto in_plane = [](const std::string& V, double x, double y) {
    return followed({{"x", "y"}, "(x'^2 + y'^2)/2", V, {}, {}, {}, {}}, state({x, y}, {0, 0}), 6);
  };
  const double left = 6 - 4 * std::sqrt(2.0);  // of a period of 4√2
  for (const char* V : {"hypot(x, y)", "sqrt(x^2 + y^2)", "norm([x, y, 0])", "(x^4)^0.25", "abs(x)"}) {
    CAPTURE(V);
    const Followed motion = in_plane(V, 1, 0);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(std::abs(motion.end().q[0] - (1 - left * left / 2)) < 1e-9);
    CHECK(std::abs(motion.end().v[0] + left) < 1e-9);
  }
  const double c = std::cos(0.7), s = std::sin(0.7);
  const Followed oblique = in_plane("hypot(x, y)", c, s);
  CHECK(std::abs(oblique.end().q[0] * c + oblique.end().q[1] * s - (1 - left * left / 2)) < 1e-9);
}

TEST_CASE("a spring of Hertz that is not touched changes nothing") {
  for (const char* stop :
       {"max(x - 0.1, 0)^1.5", "max(x - 0.1, 0)^2.5", "max(x - 0.1, 0)*sqrt(max(x - 0.1, 0))",
        "abs(max(x - 0.1, 0))^1.1", "sqrt(3*max(x - 0.1, 0)^2)*max(x - 0.1, 0)^0.5"}) {
    CAPTURE(stop);
    const Followed motion = pushed(std::string("-1000*") + stop + " - x", 0.05, 0, 5);
    CHECK(motion.motion.record().steps < 10);
    CHECK(motion.end().q[0] == doctest::Approx(0.05 * std::cos(5.0)).epsilon(1e-13));
    CHECK(motion.end().v[0] == doctest::Approx(-0.05 * std::sin(5.0)).epsilon(1e-13));
  }
}

TEST_CASE("beside a body at rest whose force has no derivative there what moves keeps its digits") {
  const Followed motion =
      followed({{"x", "y"}, "x'^2/2 + y'^2/2", "", {}, {}, {{"y", "hypot(x, x)*sqrt(abs(x)) - y"}}, {}},
               state({0, 1}, {0, 0}), 20);
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.end().q[1] == doctest::Approx(std::cos(20.0)).epsilon(1e-9));
}

TEST_CASE("a force that begins as a root of the time lifts a body from its floor") {
  for (const double start : {-3.0, 0.0, 5.0}) {
    const SystemText text{{"y"},
                          "y'^2/2",
                          "",
                          {{"s", std::to_string(start)}},
                          {},
                          {{"y", "if(t > s, sqrt(t - s), 0)"}},
                          {{"floor", "y >= 0"}}};
    const Followed found =
        followed(text, mechanics::State{start, mechanics::Vector{{0}}, mechanics::Vector{{0}}}, start + 2);
    CHECK(found.motion.status() == MotionStatus::done);
    CHECK(found.end().q[0] == doctest::Approx(4.0 / 15 * std::pow(2, 2.5)).epsilon(1e-12));
  }
}

TEST_CASE("a force that begins at rest as a power of the time is followed from there") {
  for (const double power : {0.5, 1.5, 2.2}) {
    CAPTURE(power);
    const double x = std::pow(5, power + 2) / ((power + 1) * (power + 2));
    for (const std::string t : {"t", "max(t, 0)", "abs(t)"})
      CHECK(pushed(t + "^" + std::to_string(power), 0, 0, 5).end().q[0] == doctest::Approx(x).epsilon(1e-12));
  }
}

TEST_CASE("a body waits at rest for a force that begins as a root of the time") {
  for (const double power : {0.5, 1.5}) {
    CAPTURE(power);
    const Followed motion = pushed("max(t - 1, 0)^" + std::to_string(power), 1, 0, 3);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] ==
          doctest::Approx(1 + std::pow(2, power + 2) / ((power + 1) * (power + 2))).epsilon(1e-12));
  }
}

TEST_CASE("a spring of Hertz takes up a force that begins at 0") {
  const Followed pressed = pushed("-40*max(x, 0)^1.5 + t", 0, 0, 5),
                 by_if = pushed("if(x > 0, -40*x^1.5, 0) + t", 0, 0, 5);
  REQUIRE(pressed.motion.status() == MotionStatus::done);
  CHECK(pressed.end().q[0] == doctest::Approx(by_if.end().q[0]).epsilon(1e-10));
  const Followed short_one = pushed("-40*max(x, 0)^1.5 + t", 0, 0, 1e-2);
  CHECK(short_one.end().q[0] == doctest::Approx(1e-6 / 6).epsilon(1e-3));  // t³/6 but for 2e-4 of it
}

TEST_CASE("a body at rest under drag by a power of its speed does not slow down what moves beside it") {
  for (const char* drag : {"-5*abs(x')^1.5*sign(x')", "-abs(x)^1.5*sign(x)", "(x'^2)^0.75*sign(-x')"}) {
    CAPTURE(drag);
    const Followed motion =
        followed({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {{"x", drag}, {"y", "-100*y"}}, {}},
                 state({0, 1}, {0, 0}), 3);
    CHECK(motion.motion.record().steps < 100);
    CHECK(motion.end().q[1] == doctest::Approx(std::cos(30.0)).epsilon(1e-12));
  }
}

TEST_CASE("an impact turns the velocity under drag by a power of the speed") {
  const SystemText ball{
      {"x"}, "x'^2/2", "9.81*x", {}, {}, {{"x", "-0.5*abs(x')^1.5*sign(x')"}}, {{"floor", "x >= 0"}}};
  const Followed bouncing = followed(ball, state({1}, {0}), 0.7, restitution(ball, 0.8));
  REQUIRE(bouncing.motion.status() == MotionStatus::done);
  REQUIRE(bouncing.motion.record().impacts == 1);
  // Down in ∫ dv/(g - v^p/2) to w, with ∫ v dv/(g - v^p/2) = 1; up from 0.8 w.
  const auto down = [](double u) { return 1 / (9.81 - 0.5 * std::pow(u, 1.5)); };
  const auto up = [](double u) { return 1 / (9.81 + 0.5 * std::pow(u, 1.5)); };
  double low = 3, high = 4.4;
  for (int i = 0; i < 60; ++i) {
    const double w = (low + high) / 2;
    (integral_of_squares(0, w, [&](double u) { return u * down(u); }) < 1 ? low : high) = w;
  }
  const double v = bouncing.end().v[0];
  CHECK(integral_of_squares(0, low, down) + integral_of_squares(v, 0.8 * low, up) ==
        doctest::Approx(0.7).epsilon(1e-9));
}

TEST_CASE("a spring of Hertz with damping that does not pull lets go, however it is cut off") {
  const Followed told = pushed("-9.81 - if(x > 0.5, 1000*(x - 0.5)^1.5*max(1 + 0.5*x', 0), 0)", 0, 10, 5);
  for (const char* force : {"-9.81 - max(if(x > 0.5, 1000*(x - 0.5)^1.5*(1 + 0.5*x'), 0), 0)",
                            "-9.81 - if(x > 0.5, max(1000*(x - 0.5)^1.5*(1 + 0.5*x'), 0), 0)",
                            "-9.81 - max(1000*max(x - 0.5, 0)^1.5*(1 + 0.5*x'), 0)"}) {
    CAPTURE(force);
    const Followed motion = pushed(force, 0, 10, 5);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(told.end().q[0]).epsilon(1e-10));
  }
}

TEST_CASE("a damper cut off at 0 works at each stroke") {
  const std::string spring = "-100*abs(x)^1.5*sign(x)";
  const Followed told = pushed("-if(x > 0.5, 100*(x - 0.5)^1.5*max(1 + 0.5*x', 0), 0)" + spring, 1, 0, 3);
  for (const char* damper : {"-max(if(x > 0.5, 100*(x - 0.5)^1.5*(1 + 0.5*x'), 0), 0)",
                             "-if(x > 0.5, max(100*(x - 0.5)^1.5*(1 + 0.5*x'), 0), 0)",
                             "-max(100*max(x - 0.5, 0)^1.5*(1 + 0.5*x'), 0)"}) {
    CAPTURE(damper);
    const Followed motion = pushed(damper + spring, 1, 0, 3);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(told.end().q[0]).epsilon(1e-8));
  }
}

TEST_CASE("a root from whose 0 several motions lead is refused where |x| is in it, too") {
  for (const char* force : {"sqrt(x)", "sqrt(abs(x))", "12*sqrt(max(x, 0))"}) {
    CAPTURE(force);
    CHECK_THROWS_AS(pushed(force, 0, 0, 3), convex::InvalidInput);
  }
}

TEST_CASE("a forced body between two springs of Hertz, or under drag by a power, starts from rest") {
  struct Case {
    std::string force;
    double x, v;  // at t = 3, or 1, by DOP853 (Hairer, Norsett and Wanner 1993) with steps of 1e-3
    double until = 3;
  };
  const Case cases[] = {
      {"sin(t) - 0.3*abs(x')^1.5*sign(x')", 2.2731851224, 1.2935594462},
      {"sin(t) - 1000*max(x - 0.1, 0)^1.5 - 1000*max(-x - 0.1, 0)^1.5", 0.0606573726, 0.1491790982},
      {"t^1.5 - 0.3*max(x, 0)^1.5", 0.1140302732, 0.3981493759, 1}};
  for (const Case& one : cases) {
    CAPTURE(one.force);
    const Followed motion = pushed(one.force, 0, 0, one.until);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(one.x).epsilon(1e-7));
    CHECK(motion.end().v[0] == doctest::Approx(one.v).epsilon(1e-7));
  }
}

TEST_CASE(
    "a body that rises from a soft spring to the velocity 0 where the spring is at rest falls back on it") {
  // The top of each swing is at x = 0 but for rounding, where |x|^(3/2) has no second derivative.
  const Followed motion = pushed("-9.81 - 1000*abs(x)^1.5*sign(x)", 0, 0, 4);
  CHECK(motion.motion.status() == MotionStatus::done);
  const double x = motion.end().q[0], v = motion.end().v[0];
  CHECK(std::abs(v * v / 2 + 9.81 * x + 400 * std::pow(std::abs(x), 2.5)) < 1e-12);
  const Followed one_sided = pushed("-9.81 + 1000*max(-x, 0)^1.5", 0, 0, 4);
  CHECK(x == doctest::Approx(one_sided.end().q[0]).epsilon(1e-9));
  CHECK(v == doctest::Approx(one_sided.end().v[0]).epsilon(1e-9));
}

TEST_CASE("a velocity turns under drag by two powers of it, in the time that their quadrature tells") {
  const auto drag = [](double v) { return 0.3 * std::pow(v, 1.5) + 0.2 * std::sqrt(v); };
  for (const char* force : {"1 - 0.3*abs(x')^1.5*sign(x') - 0.2*abs(x')^0.5*sign(x')",
                            "1 - 0.3*abs(x')^1.5*sign(x') - 0.2*(x'^2)^0.25*sign(x')"}) {
    CAPTURE(force);
    const Followed motion = pushed(force, 0, -1, 5);
    REQUIRE(motion.motion.status() == MotionStatus::done);
    REQUIRE(motion.end().v[0] > 0);
    const double slowing = integral_of_squares(0, 1, [&](double v) { return 1 / (1 + drag(v)); }),
                 gaining =
                     integral_of_squares(0, motion.end().v[0], [&](double v) { return 1 / (1 - drag(v)); });
    CHECK(slowing + gaining == doctest::Approx(5).epsilon(1e-10));
  }
}

TEST_CASE("a branch that hangs on roots and powers of what is 0 is that of their sign a moment later") {
  // x = t² - t is below 0 until t = 1; y'' is 1 so long, and 3 then.
  for (const char* argument : {"x", "hypot(x, 0)*x", "x*hypot(x, x^2)", "x*sqrt(x^2 + x^4)", "abs(x)^0.3*x",
                               "max(x, 0)^1.5 - max(-x, 0)^0.7", "abs(abs(x)^0.5)^0.5*x"}) {
    CAPTURE(argument);
    const Followed motion = followed({{"x", "y"},
                                      "(x'^2+y'^2)/2",
                                      "-2*x",
                                      {},
                                      {},
                                      {{"y", "if(" + std::string(argument) + " >= 0, 3, 1)"}},
                                      {}},
                                     state({0, 0}, {-1, 0}), 2);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().v[1] == doctest::Approx(4).epsilon(1e-12));
    CHECK(motion.end().q[1] == doctest::Approx(3).epsilon(1e-12));
  }
}

TEST_CASE("powers of powers of a distance are below a bound on both sides of 0, and no further") {
  constexpr double half_width = 0.0081;  // 0.3⁴
  for (const char* power : {"abs(x)^0.25", "abs(abs(sqrt(abs(x)))^0.5)", "abs(abs(abs(x)^0.5)^0.5)"}) {
    CAPTURE(power);
    const Followed motion = followed(
        {{"x", "y"}, "(x'^2+y'^2)/2", "", {}, {}, {{"y", "if(" + std::string(power) + " < 0.3, 1, 0)"}}, {}},
        state({0.1, 0}, {-1, 0}), 2);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().v[1] == doctest::Approx(2 * half_width).epsilon(1e-10));
  }
}

TEST_CASE("a slide stops a motion however the velocity is written that changes its sign there") {
  for (const char* argument : {"x'", "hypot(x', 0)*x'", "max(x', 0)^1.5 - max(-x', 0)^0.7"}) {
    CAPTURE(argument);
    const Followed motion = pushed("if(" + std::string(argument) + " > 0, -1, 2)", 0, -1, 2);
    CHECK(motion.motion.status() == MotionStatus::stopped);
    CHECK(motion.motion.why().find("slides") != std::string::npos);
  }
}

TEST_CASE("a velocity that a power of it below the first brings to rest in a finite time rests there") {
  for (const double power : {0.1, 0.35, 0.9}) {  // v' = -v^p
    CAPTURE(power);
    const std::string p = std::to_string(power);
    const Followed motion = pushed("-abs(x')^" + p + "*sign(x')", 0, 1, 20);
    CHECK(motion.motion.status() == MotionStatus::done);
    CHECK(motion.end().q[0] == doctest::Approx(1 / (2 - power)).epsilon(1e-10));
    CHECK(std::abs(motion.end().v[0]) < 1e-12);
    CHECK(motion.motion.record().steps < 1000);
  }
}

TEST_CASE(
    "a velocity that follows a slower one ever so fast stops the motion soon, not at the limit of steps") {
  // y'' and x'' are coupled: 2 √|y'| comes to 0.2 x'', so that y' is nearly 0 and its rate 1/√|y'|.
  const Followed motion = followed({{"x", "y"},
                                    "0.725*x'^2 - 0.2*x'*y' + 0.375*y'^2",
                                    "",
                                    {},
                                    {},
                                    {{"x", "-1.5*sign(x')*abs(x')^0.75"}, {"y", "-2*sign(y')*abs(y')^0.5"}},
                                    {}},
                                   {0, mechanics::Vector{{-0.3, 0}}, mechanics::Vector{{-0.8, 0.3}}}, 5);
  CHECK(motion.motion.status() == MotionStatus::stopped);
  CHECK(motion.motion.why().find("no force changes") != std::string::npos);
  CHECK(motion.motion.record().steps < 1'000'000);
}

TEST_CASE("steps that a fast force asks for are followed, however small it is beside others") {
  const Followed motion = pushed("1 + 1e-3*sin(3e5*t)*step(0.2 - t)", 0, 0, 20);
  CHECK(motion.motion.status() == MotionStatus::done);
  CHECK(motion.motion.record().steps > 20'000);
  // ∫ 1e-3 sin(w t) to 0.2 is 1e-3 (1 - cos(0.2 w))/w, and 0.2 w = 6e4.
  CHECK(motion.end().v[0] == doctest::Approx(20 + 1e-3 * (1 - std::cos(6e4)) / 3e5).epsilon(3e-11));
}
