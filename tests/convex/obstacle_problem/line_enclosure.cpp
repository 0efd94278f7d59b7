#include "convex/obstacle_problem/line_enclosure.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using convex::EnclosedLineObstacle;
using convex::Interval;
using convex::LineEnclosure;
using convex::LineEnd;
using convex::LineObstacle;
using convex::LineSeries;
using convex::LineSolution;

namespace {

using Kind = LineEnd::Kind;

/// h = c + e r², and its series: c + e a² + 2 e a t + e t².
struct Source {
  double c, e;
  double operator()(double r) const { return c + e * r * r; }
  LineSeries series(const Interval& a) const {
    const double r = 0.5 * (a.low + a.high), wide = 1e-15 * (std::abs(c) + std::abs(e) * (1 + r * r)) +
                                                    (a.high - a.low) * std::abs(e) * (2 + 2 * std::abs(r));
    const auto around = [&](double x) { return Interval{x - wide, x + wide}; };
    LineSeries made;
    made.degree = 3;
    made.c = {around(c + e * r * r), around(2 * e * r), around(e), {0, 0}};
    return made;
  }
};

EnclosedLineObstacle enclosed(const LineObstacle& problem, const Source& h) {
  return {problem.power,
          {problem.low, problem.low},
          {problem.high, problem.high},
          problem.at_low.kind,
          problem.at_high.kind,
          {problem.at_low.value, problem.at_low.value},
          {problem.at_high.value, problem.at_high.value},
          [h](const Interval& a, double) { return h.series(a); }};
}

double difference(const LineEnclosure& enclosure, const LineSolution& truth, const LineObstacle& problem) {
  double largest = 0;
  for (int k = 0; k <= 1000; ++k) {
    const double r = problem.low + (problem.high - problem.low) * k / 1000;
    largest = std::max(largest, std::abs(enclosure.p(r) - truth.p(r)));
  }
  return largest;
}

}  // namespace

TEST_CASE(
    "an enclosure on a line is as narrow as rounding where the cavity is right, and true where it is not") {
  const Source falling{-2, -3}, turning{1, -8};
  struct Scene {
    LineObstacle problem;
    Source h;
  };
  const LineEnd centre{Kind::centre, 0};
  const std::vector<Scene> scenes{
      {{0, -1, 1, {Kind::value, 0.2}, {Kind::value, 0.3}, falling}, falling},
      {{0, 0, 1, {Kind::value, 0.2}, {Kind::flux, -1}, falling}, falling},
      {{0, 0, 1, {Kind::flux, -0.1}, {Kind::flux, 0.2}, falling}, falling},
      {{0, -1, 1, {Kind::value, 0}, {Kind::value, 0.01}, turning}, turning},
      {{1, 0, 1, centre, {Kind::value, 0.2}, falling}, falling},
      {{2, 0, 1, centre, {Kind::value, 0.2}, falling}, falling},
      {{1, 0.1, 1, {Kind::value, 0.05}, {Kind::value, 0.2}, falling}, falling},
      {{2, 0.1, 1, {Kind::flux, -0.1}, {Kind::value, 0.2}, falling}, falling},
  };
  for (const Scene& scene : scenes) {
    CAPTURE(scene.problem.power);
    CAPTURE(scene.problem.low);
    const EnclosedLineObstacle problem = enclosed(scene.problem, scene.h);
    const LineSolution truth = convex::solve_line(scene.problem);
    const auto narrow = convex::enclose_line(problem, truth);
    REQUIRE(narrow);
    CHECK(narrow->error_bound <= 5e-12);
    CHECK(difference(*narrow, truth, scene.problem) <= narrow->error_bound);
    // The points with p = 0 of another problem: of more and of less pressure.
    for (const double part : {0.97, 1.03, 3.0}) {
      LineObstacle other = scene.problem;
      other.h = [&](double r) { return part * scene.h(r); };
      const auto wide = convex::enclose_line(problem, convex::solve_line(other));
      if (!wide) continue;
      const double off = difference(*wide, truth, scene.problem);
      CHECK(off <= wide->error_bound);
      CHECK(wide->error_bound >= 1e-6);
    }
  }
}

TEST_CASE("nothing is enclosed where h is not, nor p up to a constant") {
  const Source falling{-2, -3};
  const LineObstacle problem{0, 0, 1, {Kind::value, 0.2}, {Kind::value, 0.2}, falling};
  const LineSolution found = convex::solve_line(problem);
  EnclosedLineObstacle unknown = enclosed(problem, falling);
  unknown.h = [](const Interval&, double) {
    LineSeries made;
    made.c[0] = {-INFINITY, INFINITY};
    return made;
  };
  CHECK_FALSE(convex::enclose_line(unknown, found));
  const LineObstacle resting{0, 0, 1, {Kind::flux, 0}, {Kind::flux, 0}, [](double) { return 0.0; }};
  CHECK_FALSE(convex::enclose_line(enclosed(resting, {0, 0}), convex::solve_line(resting)));
}
