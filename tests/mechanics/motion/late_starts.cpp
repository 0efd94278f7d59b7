// What a motion does hangs on the time since its start; t itself matters where an expression has t in it.
#include <doctest/doctest.h>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

/// A body bounces off a wall at t = 1, and meets the edge of a slope beside it an instant later.
Followed beside_a_slope(double start, const std::string& edge, double later) {
  const SystemText text{{"x", "y"}, "(x'^2 + y'^2)/2",   "100*max(" + edge + ", 0)", {}, {},
                        {},         {{"wall", "x >= 0"}}};
  return followed(text, {start, Vector{{1, -1 - later}}, Vector{{-1, 1}}}, start + 1.5, restitution(text, 1));
}

}  // namespace

TEST_CASE("a motion without t in it is the same whenever it starts") {
  // At t = 1e8 roundings of t are 1.5e-8.
  for (const double later : {5e-7, 1e-9, 1e-12}) {
    CAPTURE(later);
    const Followed soon = beside_a_slope(0, "y", later), late = beside_a_slope(1e8, "y", later),
                   before = beside_a_slope(-1e8, "y", later);
    REQUIRE(soon.events.size() == 3);
    for (const Followed* other : {&late, &before}) {
      const double shift = other == &late ? 1e8 : -1e8;
      REQUIRE(other->motion.status() == MotionStatus::done);
      REQUIRE(other->events.size() == soon.events.size());
      for (std::size_t k = 0; k < soon.events.size(); ++k) {
        CHECK(other->events[k].kind == soon.events[k].kind);
        CHECK(other->events[k].t == shift + soon.events[k].t);
        CHECK(other->events[k].velocity_after == soon.events[k].velocity_after);
      }
      CHECK(other->end().q == soon.end().q);
      CHECK(other->end().v == soon.end().v);
    }
  }
}

TEST_CASE("a ball comes to rest at a late time as it does at an early one") {
  const SystemText text = ball();
  const Followed soon = followed(text, state({1}, {0}), 10, restitution(text, 0.9)),
                 late = followed(text, {1e8, Vector{{1}}, Vector{{0}}}, 1e8 + 10, restitution(text, 0.9));
  CHECK(late.motion.record().impacts == soon.motion.record().impacts);
  CHECK(late.of(EventKind::accumulation)[0].t == 1e8 + soon.of(EventKind::accumulation)[0].t);
  CHECK(late.motion.multipliers() == soon.motion.multipliers());
}

TEST_CASE("a kink at an impact, as far as the rounding of t tells, is no jump of the energy") {
  for (const double later : {3e-8, 1e-7}) {
    CAPTURE(later);
    const std::string edge = "y - 1e-3*sin(t - 1e8 - 1)";
    const Followed late = beside_a_slope(1e8, edge, later),
                   soon = beside_a_slope(0, "y - 1e-3*sin(t - 1)", later);
    REQUIRE(late.motion.status() == MotionStatus::done);
    CHECK((late.end().q - soon.end().q).norm() < 100 * 2 * later);  // the force may act too soon, by so much
    CHECK((late.end().v - soon.end().v).norm() < 100 * 2 * later);
  }
  const SystemText step{{"x", "y"}, "(x'^2 + y'^2)/2",   "step(y - 1e-3*sin(t - 1e8 - 1))", {}, {},
                        {},         {{"wall", "x >= 0"}}};
  const Followed jump =
      followed(step, {1e8, Vector{{1, -1 - 3e-8}}, Vector{{-1, 1}}}, 1e8 + 1.5, restitution(step, 1));
  CHECK(jump.motion.status() == MotionStatus::stopped);
}

TEST_CASE("impacts come to an end where doubles hardly tell its time") {
  // 2 v / (g (1 - e)) after the start, a sum that doubles round to 1.5e-8.
  const SystemText text = ball();
  const double lasts = 2 * 0.7 / (9.81 * (1 - 0.5));
  const Followed motion =
      followed(text, {-1e8, Vector{{0}}, Vector{{0.7}}}, -1e8 + 1, restitution(text, 0.5));
  REQUIRE(motion.motion.status() == MotionStatus::done);
  REQUIRE(motion.of(EventKind::accumulation).size() == 1);
  CHECK(motion.of(EventKind::accumulation)[0].t == -1e8 + lasts);
}

TEST_CASE("a pulse lifts a body off its floor at a late time as it does at an early one") {
  const auto lifted = [](double start) {
    const std::string pulse = "1000*exp(-((t - " + std::to_string(start) + " - 0.3)/0.01)^4) - 9.81";
    const SystemText text{{"y"}, "y'^2/2", "", {}, {}, {{"y", pulse}}, {{"floor", "y >= 0"}}};
    return followed(text, {start, Vector{{0}}, Vector{{0}}}, start + 2, restitution(text, 0));
  };
  const Followed soon = lifted(0);
  for (const double start : {100.0, 200.0, 500.0, 2000.0}) {
    CAPTURE(start);
    const Followed late = lifted(start);
    REQUIRE(late.motion.status() == MotionStatus::done);
    CHECK(late.of(EventKind::release).size() == 1);
    CHECK(late.end().q[0] == doctest::Approx(soon.end().q[0]).epsilon(1e-8));  // the pulse is t's to 1e-11
  }
}
