#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "mechanics/motion/orbit.hpp"

using namespace mechanics;

TEST_CASE("a pendulum that turns over under a torque comes to one speed") {
  LagrangianText text;
  text.coordinates = {{"a", {}}};
  text.kinetic = {"a'^2/2", {}};
  text.potential = Text{"-cos(a)", {}};
  text.forces = {{{"a", {}}, {"1.2 - 0.3*a'", {}}}};
  const auto system = lagrangian_system(text);

  OrbitQuestion question;
  question.is_free = true;                           // the period is unknown
  question.modulo = Vector{{2 * std::numbers::pi}};  // a comes back up to a turn
  const Orbit orbit = find_orbit(*system, State{0, Vector{{0}}, Vector{{4}}}, question);
  REQUIRE(orbit.is_found);  // else `why` tells
  CHECK(orbit.is_stable);
  // Over a turn the torque does as much work as the drag takes: the mean of a' over a is 1.2/0.3.
  CHECK(orbit.period == doctest::Approx(2 * std::numbers::pi / 4).epsilon(0.01));
  // Liouville: the product of the multipliers, of which one is 1, is exp(-0.3 T).
  CHECK((*orbit.multipliers)[1].real() == doctest::Approx(std::exp(-0.3 * orbit.period)).epsilon(1e-9));
}
