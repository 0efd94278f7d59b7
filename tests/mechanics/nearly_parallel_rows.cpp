#include <doctest/doctest.h>

#include <cmath>

#include "tests/mechanics/singular_answer.hpp"

using convex::Index;
using convex::Interval;

namespace {

/// Of equations in x, y, a of unit masses, pushed along x, at t = 0.
tests::Answer held(const tests::Lines& constraints) {
  const auto system =
      tests::system({{"x", "y", "a"}, "(x'^2 + y'^2 + a'^2)/2", "", {}, {}, {{"x", "1"}}, constraints});
  return tests::answer(*system, tests::state({0, 0, 0}, {0, 0, 0}));
}

bool is_unbounded(const Interval& range) { return std::isinf(range.low) && std::isinf(range.high); }

}  // namespace

TEST_CASE("a row written twice leaves the multiplier of one that is nearly parallel to it alone") {
  const std::string row = "sin(1)*x + exp(1)*y + 0.3*a", near = row + " + 1e-7*(0.3*x + sqrt(2)*a)";
  const tests::Answer found = held({{"first", row + " = pi*sin(t)^2"},
                                    {"again", "pi*(" + row + " - pi*sin(t)^2) = 0"},
                                    {"near", near + " = sqrt(7)*t^2"}});
  const convex::Multipliers& multipliers = found.solution.multipliers;
  CHECK_FALSE(multipliers.unique);
  REQUIRE(multipliers.ranges);
  CHECK(is_unbounded((*multipliers.ranges)[0]));
  CHECK(is_unbounded((*multipliers.ranges)[1]));
  CHECK((*multipliers.ranges)[2].low == (*multipliers.ranges)[2].high);
}

TEST_CASE("rows written twice do not contradict themselves where others throw the system far") {
  const std::string row = "x + exp(1)*y", near = row + " + 1e-5*x";
  const auto system = tests::system({{"x", "y"},
                                     "(x'^2 + 1e6*y'^2)/2",
                                     "",
                                     {},
                                     {},
                                     {{"x", "cos(2)"}, {"y", "sin(1)"}},
                                     {{"again", "exp(0.3)*(" + row + " - sqrt(2)*sin(t)^2) = 0"},
                                      {"near", near + " - 0.3*sin(t)^2 = 0"},
                                      {"first", row + " - sqrt(2)*sin(t)^2 = 0"}}});
  const tests::Answer found = tests::answer(*system, tests::state({0, 0}, {0, 0}));
  CHECK(found.resolution.warnings.empty());
  CHECK(found.solution.primal.status == convex::Status::solved);
  const convex::Multipliers& multipliers = found.solution.multipliers;
  REQUIRE(multipliers.ranges);
  CHECK(is_unbounded((*multipliers.ranges)[0]));
  CHECK((*multipliers.ranges)[1].low == (*multipliers.ranges)[1].high);
  CHECK(is_unbounded((*multipliers.ranges)[2]));
}
