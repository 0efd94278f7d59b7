#include "convex/obstacle_problem/cut_obstacle.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/convex/obstacle_problem/random_grid.hpp"

using convex::CutGrid;
using convex::CutPoint;
using convex::CutSolution;
using convex::Index;

namespace {

/// The gradient of the energy at a point, from its definition.
double slope(const CutGrid& grid, const std::vector<double>& q, Index k) {
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  double sum = grid.pull[at(k)] * q[at(k)] - grid.load[at(k)];
  for (std::size_t axis = 0; axis < grid.dimension; ++axis)
    for (const Index other : {k - grid.stride(axis), k + grid.stride(axis)})
      sum += grid.link[axis][at(std::min(k, other))] * (q[at(k)] - q[at(other)]);
  for (const convex::Pendant& pendant : grid.pendants)
    if (pendant.point == k) sum += pendant.conductance * std::min(0.0, q[at(k)] + pendant.shift);
  return sum;
}

}  // namespace

TEST_CASE(
    "the point found on a grid with holes, pendants and any links fulfils the conditions of a minimum") {
  std::mt19937 random(7);
  int held = 0;
  for (const auto& [dimension, points] : {std::pair{std::size_t{1}, Index{33}}, {2, 17}, {3, 9}})
    for (int trial = 0; trial < 8; ++trial) {
      CAPTURE(dimension);
      const CutGrid fine = tests::random_grid(dimension, points, random);
      const CutGrid coarse = tests::random_grid(dimension, (points + 1) / 2, random);  // it only has to help
      const CutSolution found = convex::solve_cut_grids({&fine, &coarse}).front();
      CHECK(found.ended);
      for (Index k = 0; k < fine.size(); ++k) {
        if (!fine.is_unknown(k)) continue;
        const auto i = static_cast<std::size_t>(k);
        const double here = slope(fine, found.q, k);
        if (fine.kind[i] == CutPoint::bounded) CHECK(found.q[i] >= -1e-9);
        if (fine.kind[i] == CutPoint::bounded && found.q[i] <= 1e-9)
          CHECK(here >= -1e-7);
        else
          CHECK(std::abs(here) <= 1e-7);
        held += found.held[i];
      }
    }
  CHECK(held > 100);
}

TEST_CASE("without bounds the equation holds at every unknown") {
  std::mt19937 random(8);
  CutGrid grid = tests::random_grid(2, 17, random);
  grid.pendants.clear();
  const CutSolution found = convex::solve_cut_grids({&grid}, false).front();
  double least = 0;
  for (Index k = 0; k < grid.size(); ++k) {
    if (!grid.is_unknown(k)) continue;
    CHECK(std::abs(slope(grid, found.q, k)) <= 1e-7);
    least = std::min(least, found.q[static_cast<std::size_t>(k)]);
  }
  CHECK(least < 0);
}
