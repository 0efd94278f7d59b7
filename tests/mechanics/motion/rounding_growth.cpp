#include "mechanics/motion/rounding_growth.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

std::optional<RoundingGrowth> growth(const SystemText& text, const State& start, double until,
                                     const MotionOptions& options = {}, Index most = 64) {
  const Followed found = followed(text, start, until, options);
  return rounding_growth(*found.system, start, options, found.motion, most);
}

}  // namespace

TEST_CASE("a rounding at the start of an unstable motion grows with the exponential of its rate") {
  // x'' = x: what a state is off by along x = x', (dx + dv) / 2, grows with e^t.
  // both.
  const SystemText saddle{{"x", "y"}, "x'^2/2 + y'^2/2", "-x^2/2 + 1000*y^2", {}, {}, {}, {}};
  const double T = 20;
  const auto found = growth(saddle, state({1, 1}, {-0.999999, 0}), T);
  REQUIRE(found);
  CHECK(found->coordinate == 0);
  const double dx = std::nextafter(1.0, 2.0) - 1, dv = std::nextafter(-0.999999, -2.0) + 0.999999;
  CHECK(found->change > 0.1 * 0.5 * (dx + dv) * std::exp(T));
  CHECK(found->change < 10 * 0.5 * (dx - dv) * std::exp(T));
  const double size = 0.5 * 1e-6 * std::exp(T);
  CHECK(std::abs(found->part * size / found->change - 1) <= 0.01);
}

TEST_CASE("no rounding grows in an oscillation, in rest after bounces, and in numbers that are rounding") {
  const SystemText oscillator{{"x"}, "x'^2/2", "x^2/2", {}, {}, {}, {}};
  const auto swinging = growth(oscillator, state({1}, {0.3}), 100);
  REQUIRE(swinging);
  CHECK(swinging->part == 0);
  const auto resting = growth(ball(), state({1}, {0}), 20, restitution(ball(), 0.5));
  REQUIRE(resting);
  CHECK(resting->part == 0);
  const auto tiny = growth({{"x", "y"}, "x'^2/2 + y'^2/2", "x^2/2 + y^2/2", {}, {}, {}, {}},
                           state({1, 1e-17}, {0, 1e-17}), 100);
  REQUIRE(tiny);
  CHECK(tiny->part == 0);
}

TEST_CASE("what impacts make of a rounding is told of a motion that begins on the table that throws it") {
  // Held, the ball takes up what is moved at the start; from the flight on it is as if begun there.
  SystemText text{{"y"}, "m/2*y'^2", "m*g*y", {}, {}, {}, {}};
  text.parameters = {{"m", "0.2"}, {"g", "9.81"}, {"A", "0.003"}, {"w", "2*pi*20"}};
  text.constraints = {{"table", "y >= A*sin(w*t)"}};
  const MotionOptions options = restitution(text, 0.9);
  const auto found = growth(text, state({0}, {0.003 * (2 * M_PI * 20)}), 5, options);
  REQUIRE(found);
  CHECK(found->part > 1e-4);
}

TEST_CASE("of a chaotic motion no digit is left after a minute") {
  const SystemText pendulum{
      {"a", "b"}, "a'^2 + b'^2/2 + a'*b'*cos(a - b)", "-9.81*(2*cos(a) + cos(b))", {}, {}, {}, {}};
  const auto found = growth(pendulum, state({2, 2.5}, {0, 0}), 60);
  REQUIRE(found);
  CHECK(found->part > 1e-3);
}

TEST_CASE("of a chaotic motion that begins at 0 no digit is left, and a rest that stays one loses none") {
  const SystemText duffing{{"x"}, "x'^2/2", "", {}, {}, {{"x", "x - x^3 - 0.25*x' + 0.4*cos(t)"}}, {}};
  for (const double x : {0.0, 0.001}) {
    const auto found = growth(duffing, state({x}, {0}), 300);
    REQUIRE(found);
    CHECK(found->part > 1e-3);
  }
  const SystemText upright{{"x", "y"}, "(x'^2 + y'^2)/2", "-x^2/2 + y^2/2", {}, {}, {}, {}};
  const auto standing = growth(upright, state({0, 1}, {0, 0}), 50);
  REQUIRE(standing);
  CHECK(standing->part == 0);
}

TEST_CASE("what roundings of all signs grow to is within the bound that is told, and one sign misses it") {
  // x'' = x: with (dx + dv) e^T / 2, signs that cancel leave nothing to see.
  const SystemText saddle{{"x"}, "x'^2/2", "-x^2/2", {}, {}, {}, {}};
  const double T = 20, rounding = 0x1p-52;
  const auto all = growth(saddle, state({1}, {-1}), T), one = growth(saddle, state({1}, {-1}), T, {}, 1);
  REQUIRE(all);
  REQUIRE(one);
  const double most = rounding * std::exp(T);  // |dx| = |dv| = a rounding
  CHECK(one->change < 0.5 * most);
  CHECK(one->bound_over_change == 0);
  CHECK(all->change <= 1.5 * most);
  CHECK(all->bound_over_change * all->change >= 0.9 * most);
  CHECK(all->bound_over_change == std::sqrt(2.0));
}

TEST_CASE("a bound is told where all rows of the next power of two were tried, and only there") {
  const SystemText saddle{{"x", "y"}, "(x'^2 + y'^2)/2", "-x^2/2", {}, {}, {}, {}};
  const State start = state({1, 1}, {-0.999999, 0});  // y' stays 0
  const auto all = growth(saddle, start, 20, {}, 4), some = growth(saddle, start, 20, {}, 3);
  REQUIRE(all);
  REQUIRE(some);
  CHECK(all->bound_over_change == std::sqrt(3.0));
  CHECK(some->bound_over_change == 0);
  CHECK(some->change <= all->change);
}

TEST_CASE("an impact right at the end, before it or after it by a rounding, is no growth") {
  // A block that rocks on the corners of its base, until each of its first impacts.
  const SystemText block{
      {"y", "a"},
      "y'^2/2 + 0.52/3*a'^2",
      "9.81*y",
      {},
      {},
      {},
      {{"left", "y - cos(a) - 0.2*sin(a) >= 0"}, {"right", "y - cos(a) + 0.2*sin(a) >= 0"}}};
  const State leaning = state({std::cos(0.1) + 0.2 * std::sin(0.1), 0.1}, {0, 0});
  const std::vector<MotionEvent> impacts = followed(block, leaning, 1.4).of(EventKind::impact);
  REQUIRE(impacts.size() >= 5);
  for (const MotionEvent& impact : impacts) {
    CAPTURE(impact.t);
    const auto found = growth(block, leaning, impact.t);
    REQUIRE(found);
    CHECK(found->part == 0);
  }
}

TEST_CASE("contacts that are one at the start, and part by a rounding of it, are followed") {
  // y >= 0 is all that the dome under it leaves; off x = 0 by a rounding they contradict each other by less.
  const SystemText text{{"x", "y"},
                        "(x'^2 + y'^2)/2",
                        "",
                        {},
                        {},
                        {{"x", "1"}, {"y", "-9.81"}},
                        {{"floor", "y >= 0"}, {"dome", "y >= -x^2"}}};
  const State start = state({0, 0}, {0, 0});
  const Followed found = followed(text, start, 20);
  CHECK(found.end().q[0] == doctest::Approx(200));
  CHECK(std::abs(found.end().q[1]) < 1e-12);
  CHECK_NOTHROW(rounding_growth(*found.system, start, {}, found.motion, 64));
}
