#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "mechanics/assembly.hpp"
#include "tests/mechanics/system_text.hpp"

using namespace tests;
using mechanics::Assembly;
using mechanics::AssemblyStatus;

namespace {

const SystemText ring{{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"ring", "x^2 + y^2 = 25"}}};

}  // namespace

TEST_CASE(
    "the nearest point of a circle is on the ray through the guess, and the nearest velocity is tangent") {
  const auto s = system(ring);
  const Assembly found = mechanics::assemble(*s, state({3.3, 4.4}, {1, 1}), {});
  CHECK(found.status == AssemblyStatus::solved);
  CHECK(found.state.q[0] == doctest::Approx(3).epsilon(1e-15));
  CHECK(found.state.q[1] == doctest::Approx(4).epsilon(1e-15));
  CHECK(found.moved == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(found.state.v[0] == doctest::Approx(1 - 1.4 * 0.6).epsilon(1e-14));  // less its part along (0.6, 0.8)
  CHECK(found.state.v[1] == doctest::Approx(1 - 1.4 * 0.8).epsilon(1e-14));
  CHECK(found.residual <= 1e-15);
}

TEST_CASE("no step is divided by the rounding of a gradient, and of several ends the nearest is taken") {
  const double upright = std::acos(0.0);
  // At π/2 the gradient along th is 0: z = 0.5 is met at π/6 or 5π/6.
  const SystemText rim{{"z", "th"}, "(z'^2 + th'^2)/2", "", {}, {}, {}, {{"rim", "z >= sin(th)"}}};
  const Assembly found =
      mechanics::assemble(*system(rim), state({0.5, upright}, {0, 0}), {.contacts = {}, .held = {0}});
  CHECK(found.status == AssemblyStatus::solved);
  CHECK(found.moved == doctest::Approx(2 * upright / 3).epsilon(1e-12));
  // No step goes further than the coordinate is large: th = 3.6e14 is no neighbour.
  const SystemText stop{
      {"z", "th"}, "(z'^2 + th'^2)/2", "", {}, {}, {}, {{"rim", "z >= 0.2*sin(th)"}, {"stop", "th >= pi/2"}}};
  CHECK(mechanics::assemble(*system(stop), state({0.077, upright}, {0, 0}), {.contacts = {}, .held = {0}})
            .state.q[1] == doctest::Approx(2 * upright - std::asin(0.385)).epsilon(1e-12));
  // y cos(π/2) = 1 has no y.
  const SystemText wall{
      {"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"wall", "y*cos(pi/2) - x*sin(pi/2) >= 1"}}};
  CHECK(mechanics::assemble(*system(wall), state({0, 0}, {0, 0}), {.contacts = {}, .held = {0}}).status ==
        AssemblyStatus::infeasible);
}

TEST_CASE("with all coordinates held the velocity counts too") {
  const SystemText wall{{"x"}, "x'^2/2", "", {}, {}, {}, {{"wall", "x >= 0"}}};
  const auto held = [&](double v) {
    return mechanics::assemble(*system(wall), state({0}, {v}), {.contacts = {}, .held = {0}});
  };
  CHECK(held(-0.5).status == AssemblyStatus::infeasible);
  CHECK(held(-0.5).fighting == std::vector<convex::Index>{0});
  CHECK(held(0.5).status == AssemblyStatus::solved);
}

TEST_CASE("nearness is that of the kinetic metric") {
  const auto s = system({{"x", "y"}, "4*x'^2/2 + y'^2/2", "", {}, {}, {}, {{"line", "x + y = 5"}}});
  const Assembly found = mechanics::assemble(*s, state({0, 0}, {0, 0}), {});
  // The change is along A^-1 (1, 1): (1/4, 1).
  CHECK(found.state.q[0] == doctest::Approx(1));
  CHECK(found.state.q[1] == doctest::Approx(4));
  CHECK(found.moved == doctest::Approx(std::sqrt(4 * 1 + 16)));
}

TEST_CASE("a state that satisfies everything is left as it is") {
  const auto s = system(ring);
  const Assembly found = mechanics::assemble(*s, state({3, 4}, {-4, 3}), {});
  CHECK(found.moved == 0);
  CHECK(found.state.q == state({3, 4}, {0, 0}).q);
  CHECK((found.state.v - state({0, 0}, {-4, 3}).v).norm() <= 1e-14);
}

TEST_CASE("a state that no double comes nearer to is an answer") {
  // Points of circles of many radii, each rounded: what is left is the rounding of x and y.
  const auto circle = [](double R) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%.17g", R);
    const std::string constraint = "sqrt(x^2 + y^2) = " + std::string(digits.data());
    return system({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"ring", constraint}}});
  };
  std::vector<std::array<double, 3>> points{{56100.00000000001, 10319.400530923114, 55142.723660355994}};
  for (int k = 1; k <= 60; ++k) {
    const double R = 97.5 * std::pow(1.17, k), angle = 0.1 * k;
    points.push_back({R, R * std::cos(angle), R * std::sin(angle)});
  }
  for (const auto& [R, x, y] : points) {
    CAPTURE(R);
    const Assembly found = mechanics::assemble(*circle(R), state({x, y}, {0, 0}), {});
    CHECK(found.status == AssemblyStatus::solved);
    CHECK(found.moved <= 1e-15 * R);
  }
}

TEST_CASE("a contact named closes, one that is not named is at most not violated") {
  const SystemText text{
      {"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"floor", "y >= 0"}, {"wall", "x >= 2"}}};
  const auto s = system(text);
  const Assembly free = mechanics::assemble(*s, state({1, 3}, {-1, -1}), {});
  CHECK(free.state.q == state({2, 3}, {0, 0}).q);
  CHECK(free.state.v == state({0, 0}, {0, -1}).v);
  const Assembly held = mechanics::assemble(*s, state({1, 3}, {-1, -1}), {{0}, {}});
  CHECK(held.state.q == state({2, 0}, {0, 0}).q);
  CHECK(held.state.v == state({0, 0}, {0, 0}).v);
}

TEST_CASE("a coordinate held keeps its position and its velocity") {
  const auto s = system(ring);
  const Assembly found = mechanics::assemble(*s, state({3, 4.4}, {2, 0}), {{}, {0}});
  CHECK(found.state.q[0] == 3);
  CHECK(found.state.q[1] == doctest::Approx(4).epsilon(1e-15));
  CHECK(found.state.v[0] == 2);
  CHECK(found.state.v[1] == doctest::Approx(-1.5).epsilon(1e-14));
}

TEST_CASE("constraints that exclude each other are named, and no other") {
  const auto s =
      system({{"x", "y"},
              "(x'^2 + y'^2)/2",
              "",
              {},
              {},
              {},
              {{"roof", "y <= 10"}, {"rod", "x^2 + y^2 = 4"}, {"line", "y = 0.1"}, {"wall", "x >= 3"}}});
  const Assembly found = mechanics::assemble(*s, state({2, 0.5}, {0, 0}), {});
  CHECK(found.status == AssemblyStatus::infeasible);
  CHECK(found.fighting == std::vector<mechanics::Index>{1, 3});
}

TEST_CASE("a nearest position is found where the first step from the guess leaves the nearest valley") {
  // -0.08 >= sin x, from x = 1.46 where sin is nearly 1: the ends of the intervals are locally nearest, and
  // of these -asin(0.08) or pi + asin(0.08) lie beside the guess.
  const auto s = system({{"x", "y"}, "(x'^2 + y'^2)/2", "", {}, {}, {}, {{"c", "y - sin(x) >= 0"}}});
  const Assembly found = mechanics::assemble(*s, state({1.46, -0.08}, {0, 0}), {{}, {1}});
  CHECK(found.status == AssemblyStatus::solved);
  CHECK(std::sin(found.state.q[0]) == doctest::Approx(-0.08).epsilon(1e-12));
}

TEST_CASE("a four-bar closes from a guess that is a tenth off") {
  const auto s = system({{"a", "b", "c"},
                         "(0.4*a'^2 + 1.1*b'^2 + 0.7*c'^2)/2",
                         "",
                         {},
                         {},
                         {},
                         {{"loop_x", "cos(a) + 3*cos(b) - 2.5*cos(c) = 3.2"},
                          {"loop_y", "sin(a) + 3*sin(b) - 2.5*sin(c) = 0"}}});
  const Assembly found = mechanics::assemble(*s, state({1.1, 0.35, 1.3}, {2, -0.5, 0}), {{}, {0}});
  CHECK(found.status == AssemblyStatus::solved);
  CHECK(found.state.q[0] == 1.1);
  CHECK(s->constraint_rates(found.state).f.norm() <= 1e-14);
  CHECK(s->constraint_rates(found.state).df.norm() <= 1e-13);
}

TEST_CASE("where the gradient of a constraint vanishes at the position found, no velocity is made up") {
  // x^2 + y^2 = 0 is the origin, at rest.
  const auto s = system({{"x", "y"}, "(x'^2 + y'^2)/2", "y", {}, {}, {}, {{"c", "x^2 + y^2 = 0"}}});
  const Assembly found = mechanics::assemble(*s, state({0.3, 0.2}, {1, 0.5}), {});
  CHECK(found.status == AssemblyStatus::gave_up);
  CHECK(found.singular == std::vector<mechanics::Index>{0});
  CHECK(mechanics::assemble(*s, state({0.3, 0.2}, {0, 0}), {}).status == AssemblyStatus::solved);
}

TEST_CASE("a square that is to be 0 is met by a velocity that keeps it so") {
  const auto s = system({{"x", "y"}, "(x'^2 + y'^2)/2", "y", {}, {}, {}, {{"c", "(x - y)^2 = 0"}}});
  const Assembly found = mechanics::assemble(*s, state({0.3, 0.1}, {1, 0}), {});
  CHECK(found.status == AssemblyStatus::solved);
  CHECK(found.state.v[0] == doctest::Approx(0.5).epsilon(1e-9));
  CHECK(found.state.v[1] == doctest::Approx(0.5).epsilon(1e-9));
}
