// Rests beside forces such as -√|v|: a force in time draws the body off them.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

namespace {

Followed drawn(const std::string& force) { return pushed(force, 0, 0, 1); }

}  // namespace

TEST_CASE("drag by the root of the speed lets a force that rises as the time draw a body off its rest") {
  // x'' = 2a t - k √|x'| sign x' from rest: x' = s² t² sign a, s² + k s/2 = |a|, and no other motion, for the
  // force falls in x'.
  for (const double k : {0.1, 1.0, 7.8})
    for (const double a : {0.03, -0.6, 2.0, -50.0})
      for (const std::string drag : {"sign(x')*sqrt(abs(x'))", "sign(x')*abs(x')^0.5"}) {
        CAPTURE(k);
        CAPTURE(a);
        CAPTURE(drag);
        const Followed of = drawn(std::to_string(2 * a) + "*t - " + std::to_string(k) + "*" + drag);
        REQUIRE(of.motion.status() == MotionStatus::done);
        const double s = (std::sqrt(k * k / 4 + 4 * std::abs(a)) - k / 2) / 2;
        CHECK(of.end().v[0] == doctest::Approx(std::copysign(s * s, a)).epsilon(1e-11));
        CHECK(of.end().q[0] == doctest::Approx(std::copysign(s * s / 3, a)).epsilon(1e-11));
      }
}

TEST_CASE("a rest from which roots let more than one motion lead is refused, with that reason") {
  // x' = -s² t² too, 2 s² - 3.9 s + 1 = 0 having roots.
  for (const char* force : {"-3.9*sqrt(abs(x')) + t", "-sqrt(abs(x'))", "sqrt(x)"}) {
    CAPTURE(force);
    CHECK_THROWS_WITH_AS(drawn(force), doctest::Contains("more than one motion"), convex::InvalidInput);
  }
}
