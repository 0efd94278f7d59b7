#include "convex/obstacle_problem/line_obstacle.hpp"

#include <doctest/doctest.h>

#include <cmath>

using convex::LineEnd;
using convex::LineObstacle;
using convex::LineSolution;

namespace {

LineEnd value(double p) { return {LineEnd::Kind::value, p}; }
LineEnd flux(double g) { return {LineEnd::Kind::flux, g}; }
constexpr LineEnd centre{LineEnd::Kind::centre, 0};

}  // namespace

TEST_CASE("p on a line is the least function with -(w p')' >= w h above 0, whatever h") {
  // The law: w p' falls by at least the load over every interval, and by the load itself where p > 0.
  const std::vector<LineObstacle> problems{
      {0, -1, 1, value(0.1), value(0.2), [](double x) { return -10 * std::cos(9 * x); }},
      {0, -1, 1, value(0), value(0), [](double x) { return 1 - 8 * x * x; }},
      {1, 0, 1, centre, value(1), [](double r) { return -20 * r * r; }},
      {2, 0, 1, centre, value(0.3), [](double r) { return 2 - 9 * r; }},
      {1, 0.3, 1, flux(-0.7), value(0.2), [](double) { return -1.0; }},
      {0, 0, 2, value(5), flux(-3.75), [](double) { return 0.0; }},
  };
  for (const LineObstacle& problem : problems) {
    const LineSolution found = convex::solve_line(problem);
    REQUIRE(found.status == LineSolution::Status::solved);
    const double step = 1e-3 * (problem.high - problem.low);
    const auto w = [&](double r) { return std::pow(r, problem.power); };
    for (double r = problem.low + 2.5 * step; r < problem.high - 2 * step; r += 7 * step) {
      const double p = found.p(r), before = found.p(r - step), after = found.p(r + step);
      CHECK(p >= 0);
      const double drop = (w(r - step / 2) * (p - before) - w(r + step / 2) * (after - p)) / step;
      const double load = w(r) * problem.h(r) * step, slack = 40 * step * step + 1e-9;
      CHECK(drop >= load - slack);
      if (before > 0 && after > 0) CHECK(std::abs(drop - load) <= slack);
    }
  }
}

TEST_CASE("a closed line is squeezed by loads above 0, balanced at 0, and parts below") {
  const auto disc = [](double g) {
    return LineObstacle{1, 0, 1, centre, flux(g), [](double) { return -8.0; }};
  };
  CHECK(convex::solve_line(disc(5)).status == LineSolution::Status::infeasible);
  const LineSolution balanced = convex::solve_line(disc(4)), lacking = convex::solve_line(disc(3));
  CHECK(balanced.surplus == 0);
  CHECK(balanced.p(0.5) == doctest::Approx(0.5));                               // 2 r²
  CHECK(lacking.pieces().front().high == doctest::Approx(0.5).epsilon(1e-12));  // 8 (1 - s²)/2 = 3
}

TEST_CASE("a cavity far below the first cells is found") {
  // p = p0 - (1 - r²) + …: the least value without the obstacle is -2.5e-10 at the centre of the disc.
  const LineObstacle problem{1, 0, 1, centre, value(1), [](double) { return -4.000000001; }};
  const double s = convex::solve_line(problem).pieces().front().high;
  CHECK(1 - s * s + 2 * s * s * std::log(s) == doctest::Approx(4 / 4.000000001).epsilon(1e-13));
}

TEST_CASE(
    "layers thinner than the first cells are met: at a wall that draws, and at an end with p = 0 where h > "
    "0") {
  // h = -1 beside a wall with dp/dn = g: p = (x - (1 - g))²/2 there; the cavity ends at 1 - g.
  for (const double g : {2e-4, 5e-3, 7.5e-3}) {
    const LineObstacle problem{0, 0, 1, value(1e-4), flux(g), [](double) { return -1.0; }};
    const LineSolution found = convex::solve_line(problem);
    CAPTURE(g);
    CHECK_FALSE(found.high_parts);
    CHECK(found.p(1) == doctest::Approx(g * g / 2).epsilon(1e-9));
  }
  // h = 1 over the last d, else -1: p rises as (x - s)²/2 to 1 - d, there with slope k = 1 - d - s, and falls
  // to 0: k²/2 + k d - d²/2 = 0, k = (√2 - 1) d.
  for (const double d : {1e-3, 5e-3}) {
    const LineObstacle problem{0,           0,        1,
                               value(1e-4), value(0), [d](double x) { return x > 1 - d ? 1.0 : -1.0; }};
    const LineSolution found = convex::solve_line(problem);
    CAPTURE(d);
    const double k = (std::sqrt(2.0) - 1) * d;
    CHECK(found.p(1 - d) == doctest::Approx(k * k / 2).epsilon(1e-6));
  }
}
