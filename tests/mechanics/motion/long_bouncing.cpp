// What bounces more often than impacts are followed where they end, and what never ends.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

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

TEST_CASE(
    "a body between walls that close in on it strikes ever faster, to an end that is told and not passed") {
  const SystemText closing{{"x"}, "x'^2/2", "", {}, {}, {}, {{"left", "x >= t"}, {"right", "x <= 2 - t"}}};
  for (const double speed : {0.0, 20.0}) {
    const Followed found = followed(closing, state({0.7}, {speed}), 2, restitution(closing, 1));
    CHECK(found.motion.status() == MotionStatus::stopped);
    CHECK(found.motion.why().find("gain energy") != std::string::npos);
    CHECK(found.motion.record().impacts < 1'000'000);
    CHECK(found.end().t < 1);                 // where the walls meet
    CHECK(std::abs(found.end().v[0]) > 1e4);  // each impact adds 2
    CHECK(found.motion.record().largest_penetration < 1e-12);
  }
}

TEST_CASE("where the impacts between walls that close in end with the walls together, no velocity is left") {
  const SystemText closing{{"y"}, "y'^2/2", "", {}, {}, {}, {{"floor", "y >= t"}, {"ceiling", "y <= 1"}}};
  for (const double e : {0.0, 0.2, 0.5}) {
    const Followed found = followed(closing, state({0.5}, {2}), 1.5, restitution(closing, e));
    CAPTURE(e);
    CHECK(found.motion.status() == MotionStatus::infeasible);
    CHECK(found.end().t == doctest::Approx(1).epsilon(1e-9));
    CHECK(found.motion.record().largest_penetration < 1e-12);
  }
}

TEST_CASE("a body that is driven against a wall has no velocity, whichever way the drive is written") {
  for (const std::string drive : {"x = 2*t", "-x = -2*t", "2*t = x", "-3*x = -6*t"})
    for (const double place : {0.0, 1.0}) {
      CAPTURE(drive);
      CAPTURE(place);
      const SystemText driven{
          {"x"}, "x'^2/2", "", {}, {}, {}, {{"wall", "x <= " + std::to_string(place)}, {"drive", drive}}};
      const Followed found = followed(driven, state({0}, {2}), 2, restitution(driven, 0.5));
      CHECK(found.motion.status() == MotionStatus::infeasible);
      CHECK(found.motion.excluding().size() == 2);
      CHECK(found.end().t == doctest::Approx(place / 2).epsilon(1e-12));
    }
}

TEST_CASE(
    "a body in a slot without play has no velocity that rebounds from one side, and stays without rebound") {
  const SystemText slot{{"x"}, "x'^2/2", "", {}, {}, {}, {{"left", "x >= 0"}, {"right", "x <= 0"}}};
  // f'(v+) >= -e f'(v-) from the one side, f'(v+) >= 0 from the other.
  CHECK(followed(slot, state({0}, {2}), 1, restitution(slot, 0.5)).motion.status() ==
        MotionStatus::infeasible);
  const Followed found = followed(slot, state({0}, {2}), 1, restitution(slot, 0));
  CHECK(found.motion.status() == MotionStatus::done);
  CHECK(found.end().v[0] == 0);
  CHECK(found.motion.record().impacts == 1);
}

TEST_CASE("a floor that comes up to the ceiling ever slower lays the body there, and sinks again") {
  const SystemText touching{
      {"y"}, "y'^2/2", "", {}, {}, {}, {{"floor", "y >= 1 - (t - 1)^2"}, {"ceiling", "y <= 1"}}};
  for (const double e : {0.0, 0.5, 0.9}) {
    CAPTURE(e);
    const Followed found = followed(touching, state({0.5}, {2}), 2, restitution(touching, e));
    CHECK(found.motion.status() == MotionStatus::done);
    CHECK(found.end().q[0] == doctest::Approx(1).epsilon(1e-6));
    CHECK(std::abs(found.end().v[0]) <= 1e-6);
  }
}

TEST_CASE("walls that close in and stop are followed, however many impacts there are") {
  // Between walls at 1 -+ w the speed v is kept up to small terms as 1/w.
  const SystemText closing{{"x"},
                           "x'^2/2",
                           "",
                           {},
                           {{"w", "1 - 0.9*min(t, 1)"}},
                           {},
                           {{"left", "x >= 1 - w"}, {"right", "x <= 1 + w"}}};
  const Followed found = followed(closing, state({1}, {2000}), 1.5, restitution(closing, 1));
  CHECK(found.motion.status() == MotionStatus::done);
  CHECK(found.motion.record().impacts > 10'000);
  CHECK(std::abs(found.end().v[0]) == doctest::Approx(20000).epsilon(1e-2));
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

TEST_CASE("the time of a landing that is softer than soft is uncertain by more than it is off") {
  // f = (1 - t)^p comes to 0 at t = 1 only; it is within its rounding before and after.
  for (const int p : {3, 5, 7}) {
    CAPTURE(p);
    const std::string force = std::to_string(p * (p - 1)) + "*(1 - t)^" + std::to_string(p - 2);
    const SystemText landing{{"y"}, "y'^2/2", "", {}, {}, {{"y", force}}, {{"floor", "y >= 0"}}};
    const Followed found = followed(landing, state({1}, {-double(p)}), 3, restitution(landing, 0.9));
    CHECK(found.motion.status() == MotionStatus::done);
    const double off = std::abs(found.events.at(0).t - 1);
    double told = 0;
    for (const MotionRemark& remark : found.motion.record().remarks)
      if (remark.kind == RemarkKind::slow_closing) told = remark.loss;
    CHECK(told >= off);
    CHECK(told <= 0.1);
    // Impacts that follow end as uncertainly: what they tell of it counts the first one.
    for (const MotionEvent& ending : found.of(EventKind::accumulation)) {
      double within = 0;
      for (const MotionRemark& remark : found.motion.record().remarks)
        if (remark.kind == RemarkKind::accumulation) within = std::max(within, remark.loss);
      CHECK(std::abs(ending.t - 1) <= within);
    }
  }
}

TEST_CASE("a landing however soft is one contact, and the body rests there") {
  // f = (t₀ - t)^p comes to 0 with p - 1 of its derivatives, and the force presses from there on.
  for (const double landing : {0.3, 1.0, 2.5})
    for (const int p : {3, 5, 7}) {
      if (landing > 1 && p == 7) continue;  // (2.5)^7 is so large that rounding decides how fast it comes
      CAPTURE(landing);
      CAPTURE(p);
      std::ostringstream force;
      force << p * (p - 1) << "*(" << landing << " - t)^" << p - 2;
      const SystemText text{{"y"}, "y'^2/2", "", {}, {}, {{"y", force.str()}}, {{"floor", "y >= 0"}}};
      const Followed found = followed(text, state({std::pow(landing, p)}, {-p * std::pow(landing, p - 1)}), 4,
                                      restitution(text, 0.9));
      REQUIRE(found.motion.status() == MotionStatus::done);
      REQUIRE(found.events.size() == 1);
      CHECK(found.events[0].kind == EventKind::contact);
      CHECK(found.motion.record().impacts == 0);
      const std::vector<MotionRemark>& remarks = found.motion.record().remarks;
      const double off = std::abs(found.events[0].t - landing);
      CHECK(off <= 0.02);
      CHECK(std::any_of(remarks.begin(), remarks.end(), [&](const MotionRemark& remark) {
        return remark.kind == RemarkKind::slow_closing && remark.loss >= off;
      }));
      CHECK(std::abs(found.end().q[0]) <= 1e-14);
      CHECK(found.motion.multipliers()[0] == doctest::Approx(p * (p - 1) * std::pow(4 - landing, p - 2)));
    }
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
  // The force has no bound right of its edge: at the start no branch goes on.
  for (const double start : {-3.0, 0.0, 5.0}) {
    const SystemText text{{"y"},
                          "y'^2/2",
                          "",
                          {{"s", std::to_string(start)}},
                          {},
                          {{"y", "if(t > s, 1/sqrt(t - s), 0)"}},
                          {{"floor", "y >= 0"}}};
    const Followed found = followed(text, {start, Vector{{0}}, Vector{{0}}}, start + 2);
    CHECK(found.motion.status() == MotionStatus::stopped);
    CHECK(found.end().t == start);
    CHECK(found.motion.why().find("not finite") != std::string::npos);  // nothing slides here
    CHECK(found.motion.acceleration().size() == 0);
    CHECK(found.motion.multipliers().size() == 0);
  }
}

TEST_CASE("a relay that draws a body back ever so soon is not followed to the limit of steps in vain") {
  // Half a period takes 2 v: the end is 5e9 of them away.
  const Followed motion =
      followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "-sign(x)"}}, {}}, state({0}, {1e-9}), 10);
  CHECK(motion.motion.status() == MotionStatus::stopped);
  CHECK(motion.motion.why().find("too far") != std::string::npos);
  CHECK(motion.motion.record().steps < 1'000'000);
  // So many as the limit allows are followed.
  const Followed slower =
      followed({{"x"}, "x'^2/2", "", {}, {}, {{"x", "-sign(x)"}}, {}}, state({0}, {1e-5}), 10);
  CHECK(slower.motion.status() == MotionStatus::done);
  CHECK(std::abs(slower.end().q[0]) <= 1e-10);
}

TEST_CASE(
    "a ball that bounces in a groove of two slopes, with a restitution each, comes to rest at its bottom") {
  // The bottom is the one place of least potential, and impacts with e < 1 take energy until it is there.
  struct Groove {
    double x, y, left, right, mass, ratio,
        tilt;  // the bottom; slopes; inertia in x and over it in y; of gravity
    double aside, above, speed, e_left, e_right;  // the start
  };
  for (const Groove& of :
       {Groove{-2.1, 1.44, -0.164, 0.217, 2.5, 2, -0.044, 0.1, 3.022, 0, 0, 0.3},
        Groove{-2.24, 1.23, -0.149, 0.395, 1, 1, -0.027, 1e-7, 3.041658e-6, 0, 0, 0.3},
        Groove{-2.51, -0.97, -0.766, 0.453, 1, 1, -0.176, 1e-7, 3.0961097e-6, 1e-4, 0, 0.8},
        Groove{-2.47, -1.28, -0.399, 0.51, 2.5, 2, 0.151, 1e-4, 3.0559445e-3, 3.16e-3, 0.8, 0}}) {
    const auto text_of = [](double number) { return "(" + std::to_string(number) + ")"; };
    const std::string x = "(x - " + text_of(of.x) + ")", y = "(y - " + text_of(of.y) + ")";
    const auto slope = [&](double angle) {
      return y + "*cos" + text_of(angle) + " - " + x + "*sin" + text_of(angle) + " >= 0";
    };
    const SystemText groove{
        {"x", "y"},
        text_of(of.mass) + "/2*(x'^2 + " + text_of(of.ratio) + "*y'^2)",
        "9.81*" + text_of(of.mass) + "*(y*cos" + text_of(of.tilt) + " + x*sin" + text_of(of.tilt) + ")",
        {},
        {},
        {},
        {{"left", slope(of.left)}, {"right", slope(of.right)}}};
    MotionOptions options;
    options.restitution = convex::Vector{{of.e_left, of.e_right}};
    const Followed found =
        followed(groove, state({of.x + of.aside, of.y + of.above}, {of.speed, 0}), 60, options);
    CAPTURE(of.left);
    CHECK(found.motion.status() == MotionStatus::done);
    CHECK(std::abs(found.end().q[0] - of.x) <= 1e-13);
    CHECK(std::abs(found.end().q[1] - of.y) <= 1e-13);
    CHECK(found.end().v.norm() == 0);
    CHECK(found.motion.record().steps < 10'000);
  }
}

TEST_CASE("a column of balls of different restitution, one of them 1, comes to rest where it stands") {
  // What the others leave of the one with e = 1 once they rest, by rounding, would bounce for ever.
  const SystemText column{
      {"y1", "y2", "y3", "y4"},
      "0.9/2*y1'^2 + 2.23/2*y2'^2 + 0.85/2*y3'^2 + 2.64/2*y4'^2",
      "10*(0.9*y1 + 2.23*y2 + 0.85*y3 + 2.64*y4)",
      {},
      {},
      {},
      {{"c1", "y1 >= 0"}, {"c2", "y2 >= y1 + 0.5"}, {"c3", "y3 >= y2 + 0.5"}, {"c4", "y4 >= y3 + 0.5"}}};
  MotionOptions options;
  options.restitution = convex::Vector{{0.5, 1, 0.9, 0.8}};
  const Followed found = followed(column, state({1, 2.2, 3.4, 3.9}, {0, 0, 0, 0}), 2, options);
  CHECK(found.motion.status() == MotionStatus::done);
  CHECK((found.end().q - convex::Vector{{0, 0.5, 1, 1.5}}).norm() <= 1e-13);
  CHECK(found.end().v.norm() == 0);
  CHECK(found.motion.record().steps < 10'000);
}

TEST_CASE(
    "a body that has come to rest in a corner stays there, however long, as one does that begins in it") {
  // Two slopes hold both coordinates: q'' is 0, not what rounding leaves of the weight.
  const SystemText corner{{"x", "y"},
                          "(x'^2 + y'^2)/2",
                          "9.81*(y*cos(0.1) + x*sin(0.1))",
                          {},
                          {},
                          {},
                          {{"left", "(y - 1.45)*cos(0.766) + (x + 0.48)*sin(0.766) >= 0"},
                           {"right", "(y - 1.45)*cos(0.453) - (x + 0.48)*sin(0.453) >= 0"}}};
  for (const double e : {0.0, 0.5}) {
    const Followed found = followed(corner, state({-0.4, 2.4}, {0, 0}), 1e6, restitution(corner, e));
    CAPTURE(e);
    CHECK(found.motion.status() == MotionStatus::done);
    CHECK(std::abs(found.end().q[0] + 0.48) <= 1e-14);
    CHECK(std::abs(found.end().q[1] - 1.45) <= 1e-14);
    CHECK(found.end().v.norm() <= 1e-30);
  }
}

TEST_CASE("a body at rest in a corner is not struck again when another one strikes its own wall") {
  const SystemText bodies{{"x1", "y1", "x2", "y2"},
                          "4.263/2*(x1'^2 + y1'^2) + 3/2*(x2'^2 + y2'^2)",
                          "9.9*(4.263*y1 + 3*y2)",
                          {},
                          {},
                          {{"x1", "2*sin(3*t)"}},
                          {{"shell", "x1^2 + y1^2 <= 4 + 1.715^2"},
                           {"bowl", "x2^2 + y2^2 <= 1.772875^2 + 1.660154^2 + 1.8"},
                           {"wave", "y2 - cos(x2) >= 1.660154 - cos(1.772875)"},
                           {"ramp", "x2 + y2 >= 1.772875 + 1.660154 - 1.76*(t - 1)"}}};
  State start = state({-2, 1.715, 1.772875, 1.660154}, {0, 0, 0, 0});
  start.t = 1;
  const Followed found = followed(bodies, start, 2);
  REQUIRE(found.events.size() == 2);
  CHECK(found.events[0].constraints == std::vector<Index>{1, 2});
  CHECK(found.events[1].constraints == std::vector<Index>{0});
  CHECK(found.motion.record().remarks.empty());
}
