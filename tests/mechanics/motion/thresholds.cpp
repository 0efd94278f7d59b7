// Starts beside a place where a force jumps: x'' = F on each side, in closed form.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

TEST_CASE("a slide that begins beside its threshold is told as a slide, however near") {
  // Below 0.4 the force rises as 3t, so that the slide begins by √(2/3 offset) from there.
  for (const double offset : {1e-15, 1e-14, 1e-13, 3e-13, 1e-12, 3e-12, 1e-11, 1e-9, 1e-6})
    for (const double side : {-1.0, 1.0}) {
      CAPTURE(side * offset);
      const Followed of = pushed("-15*step(x' - 0.4) + sin(3*t)", 0, 0.4 + side * offset, 2.5);
      CHECK(of.motion.status() == MotionStatus::stopped);
      CHECK(of.motion.why().find("slides") != std::string::npos);
      CHECK(of.end().t <= 1.01 * std::sqrt(2 * offset / 3));
    }
}

TEST_CASE("a start goes on from its own side of a jump of a force, however near that is") {
  for (const double offset : {1e-14, 1e-13, 1e-12, 1e-10}) {
    CAPTURE(offset);
    for (const double side : {-1.0, 1.0}) {  // away from the threshold, on either side
      const double v = -0.8 + side * offset, a = side > 0 ? 10.5 : -1.8;
      const Followed of = pushed("12.3*step(x' + 0.8) - 1.8", 0, v, 1);
      CHECK(of.motion.status() == MotionStatus::done);
      CHECK(of.end().q[0] == doctest::Approx(v + a / 2).epsilon(1e-13));
    }
    const double v = -0.5 * std::sqrt(offset);  // turned before it comes there
    const Followed turned = pushed("if(x >= 0.5, 2, -3)", 0.5 + offset, v, 1);
    CHECK(turned.end().q[0] == doctest::Approx(1.5 + offset + v).epsilon(1e-13));
    // Drawn over it from rest, at √(2 offset/a).
    const double over = std::sqrt(2 * (0.3 - (0.3 - offset)) / 2.6), left = 1 - over;
    const Followed drawn = pushed("if(x >= 0.3, 18.7, 2.6)", 0.3 - offset, 0, 1);
    CHECK(drawn.end().q[0] ==
          doctest::Approx(0.3 + 2.6 * over * left + 18.7 / 2 * left * left).epsilon(1e-11));
  }
}

TEST_CASE("a start off a threshold by no more than its rounding is told") {
  const Followed beside = pushed("if(x' >= 0.3, 1, -1)", 0, 0.1 + 0.2, 1),
                 at = pushed("if(x' >= 0.3, 1, -1)", 0, 0.3, 1);
  const auto tells = [](const Followed& of) { return !of.motion.record().remarks.empty(); };
  CHECK(tells(beside));
  CHECK(!tells(at));
  CHECK(beside.end().q[0] == doctest::Approx(0.8).epsilon(1e-14));
}
