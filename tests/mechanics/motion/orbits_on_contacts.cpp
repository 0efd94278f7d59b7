#include "mechanics/motion/orbit.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/motion/followed.hpp"

using namespace mechanics;
using namespace tests;

TEST_CASE("an orbit on a contact is found from a guess that lies behind it") {
  // A follower pressed onto its cam, y = 1 - cos(3 t), at t = 0.5; the guess is that of a slower cam.
  const SystemText text{{"y"}, "y'^2/2", "50*y", {}, {}, {}, {{"cam", "y >= 1 - cos(3*t)"}}};
  const auto made = system(text);
  OrbitQuestion question;
  question.motion = restitution(text, 0.2);
  question.period = 2 * std::acos(-1.0) / 3;
  const Orbit found = find_orbit(*made, state({1 - std::cos(1.4)}, {2.8 * std::sin(1.4)}, 0.5), question);
  CAPTURE(found.why);
  REQUIRE(found.is_found);
  CHECK(std::abs(found.start.q[0] - (1 - std::cos(1.5))) <= 1e-14);
  CHECK(std::abs(found.start.v[0] - 3 * std::sin(1.5)) <= 1e-13);
  CHECK(found.impacts.empty());
  // It goes up to 2 on the way, in a step or two.
  CHECK(std::abs(found.largest[0] - 2) <= 0.2);
}
