#include <doctest/doctest.h>

#include <string>

#include "mechanics/singular/resolution.hpp"
#include "tests/mechanics/singular_answer.hpp"

using namespace mechanics;
using tests::Answer;
using tests::answer;
using tests::error_of;
using tests::particle;

namespace {

bool is_near_power(const Vector& x, const Vector& y, double tolerance = 1e-12) {
  return (x - y).norm() <= tolerance * std::max(1.0, y.norm());
}

}  // namespace

TEST_CASE("a power that is 0 holds where its base is 0") {
  // {y^k = 0} = {y = 0}: the line in the plane; {(x² + y² - 1)² = 0}: the circle, q'' = -|v|² q + the part of
  // gravity along it.
  struct Power {
    const char* constraint;
    Vector q, v, q2;
  };
  for (const Power& power :
       {Power{"y^2 = 0", Vector{{3, 0}}, Vector{{1, 0}}, Vector{{0, 0}}},
        {"y^4 = 0", Vector{{3, 0}}, Vector{{0, 0}}, Vector{{0, 0}}},
        {"0 = -2*y*y/3", Vector{{3, 0}}, Vector{{0, 0}}, Vector{{0, 0}}},
        {"(x - y)^2 = 0", Vector{{1, 1}}, Vector{{2, 2}}, Vector{{-9.81 / 2, -9.81 / 2}}},
        {"(x^2 + y^2 - 1)^2 = 0", Vector{{1, 0}}, Vector{{0, 2}}, Vector{{-4, -9.81}}}}) {
    CAPTURE(std::string(power.constraint));
    const Answer found = answer(*particle({{"power", power.constraint}}), State{0, power.q, power.v});
    CHECK(is_near_power(found.q2(), power.q2));
    REQUIRE(found.resolution.warnings.size() == 1);
    CHECK(found.resolution.warnings[0].constraints == std::vector<Index>{0});
    CHECK(found.resolution.warnings[0].message.find("vanishes wherever it holds") != std::string::npos);
  }
  // A velocity off the line does not keep it, though d(y²)/dt is 0.
  CHECK(error_of([&] {
          answer(*particle({{"power", "y^2 = 0"}}), tests::state({0, 0}, {0, 1}));
        }).find("choose velocities that keep it") != std::string::npos);
  // Powers of constants, and one-sided ones, are what they are.
  CHECK(answer(*particle({{"floor", "y >= 0"}, {"one_sided", "x^2 >= 0"}}), tests::state({0, 0}, {0, 0}))
            .resolution.warnings.empty());
}

TEST_CASE("a product of powers holds where one of its bases is 0") {
  // {x² y³ = 0} = {x y = 0}: two wires, of which the velocity tells the one.
  for (const char* product : {"x^2*y^2 = 0", "x^2*y^3 = 0", "0 = -x*y^2*x/3"}) {
    CAPTURE(product);
    const Answer found = answer(*particle({{"wires", product}}), tests::state({0, 0}, {1, 0}));
    CHECK(is_near_power(found.q2(), Vector{{0, 0}}));
  }
}

TEST_CASE("a constraint that holds at rest just where linear forms vanish is held to these") {
  struct Valley {
    const char* constraint;
    std::size_t forms;
    Vector q2;
  };
  for (const Valley& valley : {Valley{"x^2 + y^2 = 0", 2, Vector{{0, 0}}},
                               {"y^2 = y^3", 1, Vector{{0, 0}}},
                               {"(x - y)^2 + (x - y)^4 = 0", 1, Vector{{-9.81 / 2, -9.81 / 2}}},
                               {"cosh(y - x) = 1", 1, Vector{{-9.81 / 2, -9.81 / 2}}}}) {
    CAPTURE(std::string(valley.constraint));
    const Answer found = answer(*particle({{"valley", valley.constraint}}), tests::state({0, 0}, {0, 0}));
    CHECK(found.resolution.added.size() == valley.forms);
    CHECK(is_near_power(found.q2(), valley.q2));
  }
  // Parabolas that touch are no line.
  for (const char* other : {"y^2 = y*x^2", "y^2 = x^4"}) {
    CAPTURE(std::string(other));
    CHECK(error_of([&] {
            answer(*particle({{"other", other}}), tests::state({0, 0}, {0, 0}));
          }).find("constraint other") != std::string::npos);
  }
}

TEST_CASE(
    "a constraint that holds just where linear forms have the values of a uniform motion is held to these") {
  const auto held = [](const char* constraint, double t, const Vector& q, const Vector& v) {
    return answer(*particle({{"valley", constraint}}), State{t, q, v});
  };
  const Answer point = held("x^2 + (y - t)^2 = 0", 0, Vector{{0, 0}}, Vector{{0, 1}});
  CHECK(point.resolution.added.size() == 2);
  CHECK(is_near_power(point.q2(), Vector{{0, 0}}));
  const Answer later =
      held("(x + t/2)^2 + (y - 3*t)^2 + (y - 3*t)^4 = 0", 2, Vector{{-1, 6}}, Vector{{-0.5, 3}});
  CHECK(is_near_power(later.q2(), Vector{{0, 0}}));
  // A point that speeds up is followed by no uniform motion.
  const std::string refused = error_of([&] {
    held("x^2 + (y - t^2)^2 = 0", 1, Vector{{0, 1}}, Vector{{0, 2}});
  });
  CAPTURE(refused);
  CHECK(refused.find("gradient vanishes at this state") != std::string::npos);
}
