// What bounces more often than impacts are followed where they end, and what never ends.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

TEST_CASE("a ball whose impacts end after the motion asked for is not laid to rest within it") {
  // Flights of 2 v/g, v falling by e each: after n impacts the sum of a geometric series.
  const double e = 1 - 1e-7, g = 9.81, until = 95000;
  const Followed found = followed(ball(), state({1}, {0}), until, restitution(ball(), e));
  const double fall = std::sqrt(2 / g);
  const auto time_of = [&](double n) { return fall - 2 * fall * e * std::expm1(n * std::log(e)) / (1 - e); };
  double n = std::floor(std::log1p(-(until - fall) * (1 - e) / (2 * fall * e)) / std::log(e));
  const double speed = g * fall * std::exp((n + 1) * std::log(e)), since = until - time_of(n);
  CHECK(found.motion.record().impacts == static_cast<long>(n) + 1);
  CHECK(found.end().q[0] == doctest::Approx(speed * since - g * since * since / 2).epsilon(1e-4));
  CHECK(found.end().v[0] == doctest::Approx(speed - g * since).epsilon(1e-4));
}

TEST_CASE("a body between walls that close in on it strikes ever faster, and never comes to rest") {
  const SystemText closing{{"x"}, "x'^2/2", "", {}, {}, {}, {{"left", "x >= t"}, {"right", "x <= 2 - t"}}};
  MotionOptions options = restitution(closing, 1);
  options.step_limit = 210'000;
  const Followed found = followed(closing, state({0.7}, {0}), 2, options);
  CHECK(found.motion.status() == MotionStatus::stopped);
  CHECK(found.end().t < 1);
  CHECK(std::abs(found.end().v[0]) > 1e5);  // each impact adds 2
  CHECK(found.motion.record().largest_penetration < 1e-12);
}

TEST_CASE("a light ball between a wall and a heavy one strikes as often as pi has digits") {
  // Galperin 2003: with masses 1 and 100^-N the collisions are the first N + 1 digits of pi. The heavy ball
  // turns the light one's impacts, whose intervals shrink up to there, into ones whose intervals grow.
  const SystemText balls{
      {"x", "y"}, "(x'^2 + m*y'^2)/2", "", {{"m", "1e-10"}}, {}, {}, {{"wall", "y >= 0"}, {"gap", "x >= y"}}};
  const Followed found = followed(balls, state({1, 0.5}, {-1, 0}), 10, restitution(balls, 1));
  CHECK(found.motion.status() == MotionStatus::done);
  CHECK(found.motion.record().impacts == 314159);
  CHECK(found.end().v[0] == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("an impact at the very end of a motion is in it") {
  for (const double g : {2.0, 9.81, 1.7}) {
    CAPTURE(g);
    const SystemText falling{
        {"y"}, "y'^2/2", "g*y", {{"g", std::to_string(g)}}, {}, {}, {{"floor", "y >= 0"}}};
    for (const double e : {0.0, 0.5, 1.0}) {
      const Followed found = followed(falling, state({1}, {0}), std::sqrt(2 / g), restitution(falling, e));
      REQUIRE(found.motion.record().impacts == 1);
      CHECK(found.end().v[0] == doctest::Approx(e * std::sqrt(2 * g)).epsilon(1e-14));
    }
  }
}

TEST_CASE("a motion that cannot begin stays at its time, with no accelerations told") {
  // The force has no derivative right of its edge: at the start no branch goes on.
  for (const double start : {-3.0, 0.0, 5.0}) {
    const SystemText text{{"y"},
                          "y'^2/2",
                          "",
                          {{"s", std::to_string(start)}},
                          {},
                          {{"y", "if(t > s, sqrt(t - s), 0)"}},
                          {{"floor", "y >= 0"}}};
    const Followed found = followed(text, {start, Vector{{0}}, Vector{{0}}}, start + 2);
    CHECK(found.motion.status() == MotionStatus::stopped);
    CHECK(found.end().t == start);
    CHECK(found.motion.why().find("not finite") != std::string::npos);  // nothing slides here
    CHECK(found.motion.acceleration().size() == 0);
    CHECK(found.motion.multipliers().size() == 0);
  }
}
