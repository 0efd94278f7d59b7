#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "mechanics/motion/motion.hpp"
#include "tests/mechanics/motion/followed.hpp"

using namespace tests;

namespace {

/// x and x' of a unit mass at a time, started at x with x' = v.
std::pair<double, double> moved(const std::string& force, double x, double v, double until,
                                const std::string& potential = "") {
  const auto s = system({{"x"}, "x'^2/2", potential, {}, {}, {{"x", force}}, {}});
  mechanics::Motion motion(*s, state({x}, {v}), {});
  while (motion.advance(until)) {
  }
  return {motion.state().q[0], motion.state().v[0]};
}

}  // namespace

TEST_CASE("a motion goes over the edges of its forces at the instant when it comes to them") {
  // From -1/2 with acceleration 1 to 0 at t = 1, half a swing of sin(2s)/2, and back to -1/2 at 2 + π/2.
  const auto [x, v] = moved("-4*max(x, 0) + if(x < 0, 1, 0)", -0.5, 0, 2 + std::numbers::pi / 2);
  CHECK(x == doctest::Approx(-0.5).epsilon(1e-12));
  CHECK(std::abs(v) <= 1e-11);
}

TEST_CASE("a motion finds the edges of its forces however fast it is") {
  // A spring four times as stiff on one side: half a swing of π/s there, of π/(2s) here.
  for (const char* s : {"1", "10", "30", "100", "1000", "1e4", "1e6", "1e-3"}) {
    CAPTURE(s);
    const double rate = std::stod(s), period = 1.5 * std::numbers::pi / rate;
    const std::string force = "-" + std::string(s) + "^2*(x + 3*max(x, 0))";
    const auto [x, v] = moved(force, -1, 0, 3 * period);
    CHECK(x == doctest::Approx(-1).epsilon(1e-10));
    CHECK(std::abs(v) <= 1e-6 * rate);
    const auto [up, speed] = moved(force, -1, 0, period / 2);
    CHECK(up == doctest::Approx(0.5).epsilon(1e-10));
    CHECK(std::abs(speed) <= 1e-6 * rate);
  }
}

TEST_CASE("a force that is a power of time moves a free body by that power and two more") {
  const double t = 1.25;
  for (const int power : {0, 1, 2, 3, 7, 12, 17})
    for (const std::string start : {"", "t*"}) {  // as a variable alone, and as a factor
      const int p = start.empty() ? power : power + 1;
      const auto [x, v] = moved(start + "t^" + std::to_string(power), 0, 0, t);
      CHECK(v == doctest::Approx(std::pow(t, p + 1) / (p + 1)).epsilon(1e-14));
      CHECK(x == doctest::Approx(std::pow(t, p + 2) / ((p + 1) * (p + 2))).epsilon(1e-14));
    }
  CHECK(moved("t", 0, 0, t).first == doctest::Approx(std::pow(t, 3) / 6).epsilon(1e-14));
  CHECK(moved("x'", 1, 1, t).first == doctest::Approx(std::exp(t)).epsilon(1e-14));
}

TEST_CASE("a branch that is not taken may be undefined all along a motion") {
  CHECK(moved("if(x >= 0, sqrt(x), 0)", -2, 1, 1).first == doctest::Approx(-1).epsilon(1e-14));
  CHECK(moved("0", -2, 1, 1, "if(x >= 0, sqrt(x), x)").first == doctest::Approx(-1.5).epsilon(1e-14));
}

TEST_CASE("a motion along a table knows its knots and stops at its end") {
  // y'' of the spline through (0, 0), (1, 1), (2, 0) is -3t up to 1 and -3(2 - t) from there.
  const auto [x, v] = moved("table(t, [0, 1, 2], [0, 1, 0])", 0, 0, 1.5);
  // ∫∫ (3t/2 - t³/2) to 1: 1/4 - 1/40, slope 3/4 - 1/8; then with u = 2 - t, by symmetry.
  const auto inner = [](double u) { return 0.75 * u * u - u * u * u * u / 8; };
  CHECK(v == doctest::Approx(2 * inner(1) - inner(0.5)).epsilon(1e-12));
  const auto outer = [](double u) { return u * u * u / 4 - std::pow(u, 5) / 40; };
  CHECK(x == doctest::Approx(outer(1) + 2 * inner(1) * 0.5 - (outer(1) - outer(0.5))).epsilon(1e-12));
  const auto s = system({{"x"}, "x'^2/2", "", {}, {}, {{"x", "table(t, [0, 1, 2], [0, 1, 0])"}}, {}});
  mechanics::Motion motion(*s, state({0}, {0}), {});
  while (motion.advance(3)) {
  }
  CHECK(motion.state().t == doctest::Approx(2));
}

TEST_CASE("an impact turns the velocity, and with it the branch of a drag that opposes it") {
  // y'' = -g - k y'|y'| after a fall from 2: down, v² = g/k (1 - e^(-2kh)); up to h = ln(1 + k v²/g)/(2k) in
  // atan(v √(k/g))/√(gk), down again in acosh(e^(kh))/√(gk).
  const double g = 9.81, k = 0.3, e = 0.8, root = std::sqrt(g * k);
  const auto fall = [&](double h) { return std::acosh(std::exp(k * h)) / root; };
  const auto speed = [&](double h) { return std::sqrt(g / k * (1 - std::exp(-2 * k * h))); };
  std::vector<double> truth{fall(2)};
  double v = e * speed(2);
  for (int j = 0; j < 3; ++j) {
    const double h = std::log(1 + k * v * v / g) / (2 * k);
    truth.push_back(truth.back() + std::atan(v * std::sqrt(k / g)) / root + fall(h));
    v = e * speed(h);
  }
  for (const char* drag : {"y'*abs(y')", "y'^2*sign(y')", "if(y' > 0, y'^2, -y'^2)", "y'*max(y', -y')"}) {
    CAPTURE(drag);
    const auto s = system(
        {{"y"}, "y'^2/2", "", {}, {}, {{"y", std::string("-9.81 - 0.3*") + drag}}, {{"floor", "y >= 0"}}});
    mechanics::MotionOptions options;
    options.restitution = convex::Vector::Constant(1, e);
    mechanics::Motion motion(*s, state({2}, {0}), options);
    std::vector<double> found;
    bool goes_on = true;
    while (goes_on) {
      goes_on = motion.advance(truth.back() + 1e-3);
      for (const auto& event : motion.events())
        if (event.kind == mechanics::EventKind::impact && (found.empty() || event.t > found.back()))
          found.push_back(event.t);
    }
    REQUIRE(found.size() == truth.size());
    for (std::size_t j = 0; j < truth.size(); ++j)
      CHECK(found[j] == doctest::Approx(truth[j]).epsilon(1e-12));
  }
}

TEST_CASE("a body that comes back from the place where its force would change has taken no branch") {
  const SystemText text{{"x"}, "x'^2/2", "", {}, {}, {{"x", "-3*sign(x) - 1"}}, {{"floor", "x >= 0"}}};
  const auto s = system(text);
  mechanics::MotionOptions options;
  options.restitution = convex::Vector::Constant(1, 0.5);
  mechanics::Motion motion(*s, state({1}, {0}), options);
  std::vector<double> impacts;
  while (motion.advance(2))
    for (const auto& event : motion.events()) {
      CHECK(event.kind == mechanics::EventKind::impact);
      impacts.push_back(event.t);
    }
  REQUIRE(impacts.size() > 2);
  const double fall = std::sqrt(0.5);  // the weight is 4
  CHECK(impacts[0] == doctest::Approx(fall).epsilon(1e-14));
  CHECK(impacts[2] == doctest::Approx(fall * 2.5).epsilon(1e-14));
}

TEST_CASE("where a velocity stays 0 a drag against it is 0, until the body is lifted") {
  // 2 g = 19.62 pushes down, t up, and 3 against the motion: it begins at t = 19.62 + 3 with the floor left.
  const SystemText text{{"y"}, "y'^2", "19.62*y", {}, {}, {{"y", "t - 3*sign(y')"}}, {{"floor", "y >= 0"}}};
  const auto s = system(text);
  mechanics::Motion motion(*s, state({0}, {0}), {});
  while (motion.advance(10)) {
  }
  CHECK(motion.multipliers()[0] == doctest::Approx(9.62).epsilon(1e-14));
  while (motion.advance(25)) {
  }
  const double since = 25 - 22.62;
  CHECK(motion.state().q[0] == doctest::Approx(since * since * since / 12).epsilon(1e-12));
}

TEST_CASE("a potential that jumps by a millionth of the energy stops a motion") {
  const auto s = system({{"x"}, "x'^2/2", "if(x > 0, 1e-6, 0)", {}, {}, {}, {}});
  mechanics::Motion motion(*s, state({-1}, {1}), {});
  while (motion.advance(2)) {
  }
  CHECK(motion.status() == mechanics::MotionStatus::stopped);
  CHECK(motion.why().find("potential energy jumps") != std::string::npos);
  CHECK(motion.state().t == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("why a motion ends is what is there, not what lies a little further") {
  // x sticks at t = 1; the table of y ends half a nanometre beyond where y is then.
  const auto s = system({{"x", "y"},
                         "x'^2/2 + y'^2/2",
                         "",
                         {},
                         {},
                         {{"x", "0.5 - sign(x')"}, {"y", "table(y, [0, 0.5, 1.0000000005], [0, 0, 0])"}},
                         {}});
  mechanics::Motion motion(*s, state({0, 0}, {0.5, 1}), {});
  while (motion.advance(3)) {
  }
  CHECK(motion.status() == mechanics::MotionStatus::stopped);
  CHECK(motion.why().find("dry friction") != std::string::npos);
}

TEST_CASE(
    "a motion that stops where no branch goes on has no acceleration there; one stopped by a limit has") {
  // Half periods of pi/2 around -+1/8: it turns at 1.1, -0.85, 0.6, -0.35, 0.1, where friction holds it.
  const SystemText text{{"x"}, "x'^2/2", "2*x^2", {}, {}, {{"x", "-0.5*sign(x')"}}, {}};
  const Followed sticks = followed(text, state({1.1}, {0}), 10);
  REQUIRE(sticks.motion.status() == mechanics::MotionStatus::stopped);
  CHECK(sticks.end().t == doctest::Approx(2 * std::acos(-1.0)).epsilon(1e-12));
  CHECK(sticks.motion.acceleration().size() == 0);
  CHECK(sticks.motion.multipliers().size() == 0);
  mechanics::MotionOptions few;
  few.step_limit = 3;
  const Followed limited = followed(text, state({1.1}, {0}), 10, few);
  REQUIRE(limited.motion.status() == mechanics::MotionStatus::stopped);
  REQUIRE(limited.motion.acceleration().size() == 1);
  const double expected = -4 * limited.end().q[0] - 0.5;  // from -0.35 on x' > 0
  CHECK(limited.motion.acceleration()[0] == doctest::Approx(expected).epsilon(1e-12));
}

TEST_CASE("a band of small velocities is entered however slow the velocity is in it") {
  // x'' = -1 outside |x'| < b, -b inside: from x' = 1 the band takes 2 s, back to the place where it began.
  for (const double b : {1e-3, 1e-4}) {
    const std::string band = b == 1e-3 ? "1e-3" : "1e-4";
    for (const std::string& force :
         {"if(x'^2 < " + band + "^2, -" + band + ", -1)", "if(abs(x') < " + band + ", -" + band + ", -1)"}) {
      CAPTURE(force);
      const Followed motion = pushed(force, 0, 1, 5);
      const double left = 5 - (1 - b) - 2;
      CHECK(motion.motion.status() == mechanics::MotionStatus::done);
      CHECK(std::abs(motion.end().q[0] - ((1 - b * b) / 2 - b * left - left * left / 2)) < 1e-8);
      CHECK(std::abs(motion.end().v[0] + b + left) < 1e-8);
    }
  }
}

TEST_CASE("a motor of constant power starts from rest by the torque to which it is limited") {
  const Followed cut = followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "min(5, 10/abs(x')) - 0.1*x'"}}, {}},
                                state({0}, {0}), 20),
                 told = followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "if(x' < 2, 5, 10/x') - 0.1*x'"}}, {}},
                                 state({0}, {0}), 20);
  CHECK(cut.motion.status() == mechanics::MotionStatus::done);
  CHECK(cut.end().q[0] == doctest::Approx(told.end().q[0]).epsilon(1e-12));
  CHECK(cut.of(mechanics::EventKind::branch).size() == 1);
}

TEST_CASE("a motor of constant power brakes a body, and drives it on when it has turned") {
  const auto driven = [](const std::string& force, double v) { return pushed(force, -1, v, 4); };
  for (const char* spring : {"-x", "-100*x", "-abs(x)^1.5*sign(x)", "-9.81"})
    for (const double v : {3.0, -1.0}) {
      CAPTURE(spring);
      CAPTURE(v);
      const Followed cut = driven("0.5*min(3, 1/abs(x')) + " + std::string(spring), v),
                     told = driven("0.5*if(abs(x') < 1/3, 3, 1/abs(x')) + " + std::string(spring), v);
      CHECK(cut.motion.status() == mechanics::MotionStatus::done);
      CHECK(cut.end().q[0] == doctest::Approx(told.end().q[0]).epsilon(1e-9));
      CHECK(cut.end().v[0] == doctest::Approx(told.end().v[0]).epsilon(1e-9));
    }
}

TEST_CASE("a fall into a pole stops, and what is known by then is told") {
  const Followed fall =
      followed({{"r", "a"}, "(r'^2 + r^2*a'^2)/2", "", {}, {}, {{"r", "-1/r^2"}, {"a", "-a'"}}, {}},
               state({0.8, 0}, {0, 0.5}), 5);
  CHECK(fall.motion.status() == mechanics::MotionStatus::stopped);
  CHECK(fall.end().t < 0.9);
  CHECK(std::isfinite(fall.motion.energy()));
  CHECK(fall.end().q[0] > 0);
  CHECK(fall.end().q[0] < 1e-4);
}

TEST_CASE("a follower that rests on a cam of a table goes through its knots without an impact") {
  const std::pair<double, std::vector<double>> cams[] = {{10, {0, 0.0079, 0, 0.0079, 0}},
                                                         {3, {0.019, 0.01, 0.01, 0, 0.01, 0.01, 0.019}},
                                                         {30, {0, 0.004, 0.012, 0.015, 0.012, 0.004, 0}}};
  for (const auto& [w, y] : cams) {
    // y'' of the natural spline: M_(i-1) + 4 M_i + M_(i+1) = 6 (y_(i-1) - 2 y_i + y_(i+1)), 0 at both ends.
    std::vector<double> M(y.size(), 0.0);
    for (int sweep = 0; sweep < 100; ++sweep)  // each halves the error, at least
      for (std::size_t i = 1; i + 1 < y.size(); ++i)
        M[i] = (6 * (y[i - 1] - 2 * y[i] + y[i + 1]) - M[i - 1] - M[i + 1]) / 4;
    std::string knots, values;
    for (std::size_t i = 0; i < y.size(); ++i) {
      knots += (i > 0 ? ", " : "") + std::to_string(i);
      values += (i > 0 ? ", " : "") + std::to_string(y[i]);
    }
    const std::string cam = "table(" + std::to_string(w) + "*t, [" + knots + "], [" + values + "])";
    const SystemText follower{{"h"}, "h'^2/2", "h*1000", {}, {}, {}, {{"cam", "h >= " + cam}}};
    const double x = 0.05, slope = y[1] - y[0] - M[1] / 6;
    const mechanics::State start{x / w, mechanics::Vector{{y[0] + slope * x + M[1] * x * x * x / 6}},
                                 mechanics::Vector{{w * (slope + M[1] * x * x / 2)}}};
    for (std::size_t i = 1; i + 1 < y.size(); ++i) {
      CAPTURE(cam);
      CAPTURE(i);
      const Followed motion = followed(follower, start, static_cast<double>(i) / w);
      CHECK(motion.of(mechanics::EventKind::impact).empty());
      CHECK(motion.of(mechanics::EventKind::release).empty());
      CHECK(motion.motion.acceleration()[0] == doctest::Approx(w * w * M[i]).epsilon(1e-9));
    }
  }
}
