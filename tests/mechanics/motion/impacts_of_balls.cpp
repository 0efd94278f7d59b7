#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

TEST_CASE("a ball with e = 0.9 strikes at every time of the geometric series, and then rests on its weight") {
  const SystemText text = ball();
  const Followed found = followed(text, state({1}, {0}), 10, restitution(text, 0.9));
  const std::vector<MotionEvent> impacts = found.of(EventKind::impact);
  REQUIRE(impacts.size() > 150);
  const long double fall = std::sqrt(2.0L / 9.81L), e = 0.9L;
  long double t = fall, flight = 2 * fall;
  for (const MotionEvent& impact : impacts) {
    CHECK(std::abs(impact.t - static_cast<double>(t)) <= 1e-13 * static_cast<double>(t));
    CHECK(impact.velocity_after[0] == doctest::Approx(-0.9 * impact.velocity_before[0]).epsilon(1e-15));
    flight *= e;
    t += flight;
  }
  const std::vector<MotionEvent> ends = found.of(EventKind::accumulation);
  REQUIRE(ends.size() == 1);
  CHECK(std::abs(ends[0].t - 8.578949178728887) <= 1e-12);
  CHECK(found.end().t == 10);
  CHECK(found.end().q[0] == 0);
  CHECK(found.end().v[0] == 0);
  CHECK(found.motion.multipliers()[0] == doctest::Approx(2 * 9.81).epsilon(1e-15));
  CHECK(found.motion.record().impacts == static_cast<long>(impacts.size()));
}

TEST_CASE(
    "an accumulation from the floor comes at 2 v / (g (1 - e)), and impacts of many thousands end as well") {
  const SystemText text = ball();
  const Followed up = followed(text, state({0}, {1}), 3, restitution(text, 0.9));
  REQUIRE(up.of(EventKind::accumulation).size() == 1);
  CHECK(up.of(EventKind::accumulation)[0].t == doctest::Approx(2 / (9.81 * (1 - 0.9))).epsilon(1e-14));
  // A state that strikes at once: from q = 0, v = -1.
  const Followed down = followed(text, state({0}, {-1}), 3, restitution(text, 0.9));
  REQUIRE(down.events.size() > 2);
  CHECK(down.events[0].t == 0);
  CHECK(std::abs(down.of(EventKind::accumulation)[0].t - 1.8348623853211012) <= 1e-13);
  const Followed long_one = followed(text, state({0}, {1}), 1e5, restitution(text, 0.99999));
  REQUIRE(long_one.of(EventKind::accumulation).size() == 1);
  CHECK(long_one.of(EventKind::accumulation)[0].t ==
        doctest::Approx(2 / (9.81 * (1 - 0.99999))).epsilon(1e-9));
  CHECK(long_one.motion.record().steps < 200000);
  CHECK(long_one.motion.record().remarks.size() == 1);
}

TEST_CASE("a ball between floor and ceiling strikes them at the times of its parabolas") {
  SystemText text{{"q"}, "q'^2/2", "10*q", {}, {}, {}, {{"floor", "q >= 0"}, {"ceiling", "q <= 1.5"}}};
  const Followed found = followed(text, state({1}, {10}), 0.75, restitution(text, 0.8));
  const double times[] = {0.0513167019494862, 0.2283187800528825, 0.4665486160195453, 0.7413599657472243};
  REQUIRE(found.events.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(std::abs(found.events[k].t - times[k]) <= 1e-14);
    CHECK(found.events[k].constraints == std::vector<Index>{k % 2 == 0 ? 1 : 0});
  }
}

TEST_CASE("the end of infinitely many impacts on a moving floor is that in the frame of the floor") {
  // Where f is a difference of large numbers, rounding decides the last bounces, but not their end.
  struct Case {
    const char* floor;
    double weight, speed;  // in the frame of the floor
  };
  constexpr double e = 0.8, end = 10, g = 9.81;
  for (const auto& [floor, weight, speed] :
       {Case{"y >= 0.7*t", g, -0.7}, Case{"y >= 1.5*t^2", g + 3, 0}, Case{"y >= 0", g, 0}}) {
    const SystemText text = ball(floor);
    const auto motion = followed(text, state({1}, {0}), end, restitution(text, e));
    const double strike = std::sqrt(speed * speed + 2 * weight), first = (strike + speed) / weight;
    const auto ends = motion.of(EventKind::accumulation);
    REQUIRE(ends.size() == 1);
    CHECK(ends[0].t == doctest::Approx(first + 2 * strike * e / (weight * (1 - e))).epsilon(1e-13));
  }
}

TEST_CASE("where terms of f in t cancel, the end of infinitely many impacts is off by no more than is told") {
  // On y >= u t + a t^2/2 the ball moves as one on a floor at rest in the weight g + a: the closed form to 30
  // digits.
  SystemText text = ball("y >= 0.08152705752887905*t - 0.006565347298718829/2*t^2");
  text.parameters = {{"m", "2.3"}, {"g", "0.12493972057479522"}};
  constexpr double true_end = 26.3805826678078176, e = 0.28283326731996;
  const auto motion =
      followed(text, state({6.793289274146516}, {0.6890086089828469}), 31, restitution(text, e));
  const auto ends = motion.of(EventKind::accumulation);
  REQUIRE(ends.size() == 1);
  double told = 1e-10 * true_end;  // up to the tolerance nothing need be said
  for (const auto& remark : motion.motion.record().remarks)
    if (const auto at = remark.what.find("within "); at != std::string::npos)
      told = std::stod(remark.what.substr(at + 7));
  CHECK(std::abs(ends[0].t - true_end) <= told);
}

TEST_CASE("units do not decide whether a floor is met") {
  // Powers of the step leave the range of doubles long before the terms of the series do.
  const SystemText text = ball();
  for (const double second : {1e-20, 1e-9, 1e9, 1e20}) {
    SystemText in_units = text;
    in_units.parameters = {{"m", "2"}, {"g", ""}};
    std::ostringstream weight;
    weight.precision(17);
    weight << 9.81 / second / second;
    in_units.parameters[1].second = weight.str();
    const auto motion = followed(in_units, state({1}, {0}), 10 * second, restitution(text, 0.9));
    const auto ends = motion.of(EventKind::accumulation);
    REQUIRE(ends.size() == 1);
    CHECK(ends[0].t / second == doctest::Approx(8.578949178728887).epsilon(1e-12));
  }
}

TEST_CASE("a ball just above the floor strikes it when it comes there, and what is not sure is told") {
  const SystemText text = ball();
  const double height = 1e-10, speed = 1e-4;
  const auto motion = followed(text, state({height}, {-speed}), 1e-5, restitution(text, 0.5));
  REQUIRE(!motion.events.empty());
  const double strike = std::sqrt(speed * speed + 2 * 9.81 * height);
  CHECK(motion.events[0].t == doctest::Approx((strike - speed) / 9.81).epsilon(1e-12));
  CHECK(motion.motion.record().remarks.empty());
  const auto within = followed(text, state({height}, {0}), 1, restitution(text, 0.5));
  CHECK(within.motion.record().remarks.size() == 1);
  // Up to a ceiling that it reaches with next to no speed.
  SystemText under = ball("y <= 1");
  const auto graze =
      followed(under, state({0}, {std::sqrt(2 * 9.81 * (1 + 1e-14))}), 1, restitution(text, 1));
  REQUIRE(graze.events.size() == 1);
  CHECK(graze.motion.record().remarks.size() == 1);
}

TEST_CASE("with e = 1 energy is kept over 100000 impacts") {
  const SystemText text = ball();
  const Followed found = followed(text, state({1}, {0}), 90320, restitution(text, 1));
  CHECK(found.motion.record().impacts >= 100000);
  CHECK(std::abs(found.motion.energy() - 2 * 9.81) <= 1e-11 * 2 * 9.81);
  CHECK(found.motion.record().largest_penetration <= 1e-15);
}

TEST_CASE("two balls that fall beside each other come to rest each in its own time") {
  SystemText text{
      {"x", "y"}, "(x'^2 + y'^2)/2", "9.81*(x + y)", {}, {}, {}, {{"a", "x >= 0"}, {"b", "y >= 0"}}};
  MotionOptions options;
  options.restitution = Vector{{0.8, 0.9}};
  const Followed found = followed(text, state({1, 0.7}, {0, 0}), 12, options);
  const std::vector<MotionEvent> ends = found.of(EventKind::accumulation);
  REQUIRE(ends.size() == 2);
  CHECK(ends[0].t == doctest::Approx(std::sqrt(2 / 9.81) * (1 + 2 * 0.8 / 0.2)).epsilon(1e-13));
  CHECK(ends[1].t == doctest::Approx(std::sqrt(1.4 / 9.81) * (1 + 2 * 0.9 / 0.1)).epsilon(1e-13));
  CHECK(found.end().q == Vector::Zero(2));
}

TEST_CASE("a bouncing ball comes to rest on a floor that moves, and goes on with it") {
  const SystemText text = ball("y >= 0.01*sin(3*t)");
  const Followed found = followed(text, state({1}, {0}), 10, restitution(text, 0.7));
  REQUIRE(found.of(EventKind::accumulation).size() == 1);
  CHECK(found.of(EventKind::release).empty());
  CHECK(found.end().q[0] == doctest::Approx(0.01 * std::sin(30.0)).epsilon(1e-14));
  CHECK(found.motion.multipliers()[0] == doctest::Approx(2 * (9.81 - 0.09 * std::sin(30.0))).epsilon(1e-12));
}

TEST_CASE(
    "a block that rocks with e = 0 loses speed by a ratio and lands flat, or stops at once if it is wide") {
  const auto block = [](const char* b, const char* h) {
    return SystemText{{"x", "y", "a"},
                      "(x'^2 + y'^2)/2 + (b^2 + h^2)/6*a'^2",
                      "9.81*y",
                      {{"b", b}, {"h", h}},
                      {},
                      {},
                      {{"left", "y - h*cos(a) - b*sin(a) >= 0"}, {"right", "y - h*cos(a) + b*sin(a) >= 0"}}};
  };
  const double h = 1, b = 0.2, a = 0.1;
  const Followed slim =
      followed(block("0.2", "1"), state({0, h * std::cos(a) + b * std::sin(a), a}, {0, 0, 0}), 5);
  const std::vector<MotionEvent> impacts = slim.of(EventKind::impact);
  REQUIRE(impacts.size() > 20);
  const double ratio = (h * h - 2 * b * b) / (h * h + 4 * b * b);
  for (std::size_t k = 0; k < 20; ++k)
    CHECK(impacts[k].velocity_after[2] / impacts[k].velocity_before[2] ==
          doctest::Approx(ratio).epsilon(1e-8));
  REQUIRE(slim.of(EventKind::accumulation).size() == 1);
  CHECK(slim.of(EventKind::accumulation)[0].constraints == std::vector<Index>{0, 1});
  CHECK(slim.motion.multipliers()[0] == doctest::Approx(9.81 / 2).epsilon(1e-12));

  const double wide = 0.8;  // 2 b^2 > h^2
  const Followed stops =
      followed(block("0.8", "1"), state({0, h * std::cos(a) + wide * std::sin(a), a}, {0, 0, 0}), 5);
  CHECK(stops.of(EventKind::impact).size() == 1);
  CHECK(stops.end().v.norm() <= 1e-14);
  CHECK(stops.motion.multipliers().minCoeff() > 4);
}

TEST_CASE("a block that lands flat and slowly strikes with both corners at once") {
  // Corners at +-1/20 strike at one time up to the rounding of f, which over the low speed is much more than
  // that of t; one after the other they would set the block spinning.
  const SystemText text{{"y", "a"},
                        "(y'^2 + a'^2/1000)/2",
                        "",
                        {},
                        {},
                        {},
                        {{"left", "y - sin(a)/20 + (1 - cos(a))/40 + 0.3 - 0.1 - 0.2 >= 0"},
                         {"right", "y + sin(a)/20 + (1 - cos(a))/40 + 0.3 - 0.2 - 0.1 >= 0"}}};
  for (const double speed : {1.0, 1e-3, 1e-6}) {
    const Followed found = followed(text, state({speed, 0}, {-speed, 0}), 1.5, restitution(text, 0.4));
    REQUIRE(found.events.size() == 1);
    CHECK(found.events[0].constraints.size() == 2);
    CHECK(std::abs(found.end().v[1]) <= 1e-12 * speed);
    CHECK(found.end().v[0] == doctest::Approx(0.4 * speed).epsilon(1e-12));
  }
}
