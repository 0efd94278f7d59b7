#include "convex/obstacle_problem/cut_enclosure.hpp"

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

/// The minimum by sweeps over single unknowns in long double, each to the minimum of its own parabola pieces.
std::vector<double> swept_minimum(const CutGrid& grid) {
  std::vector<long double> q(static_cast<std::size_t>(grid.size()), 0);
  const auto at = [](Index k) { return static_cast<std::size_t>(k); };
  for (int sweep = 0; sweep < 40000; ++sweep) {
    long double change = 0;
    for (Index k = 0; k < grid.size(); ++k) {
      if (!grid.is_unknown(k)) continue;
      long double weight = grid.pull[at(k)], sum = grid.load[at(k)];
      for (std::size_t axis = 0; axis < grid.dimension; ++axis)
        for (const Index other : {k - grid.stride(axis), k + grid.stride(axis)}) {
          const long double link = grid.link[axis][at(std::min(k, other))];
          weight += link;
          sum += link * q[at(other)];
        }
      for (const convex::Pendant& pendant : grid.pendants)
        if (pendant.point == k && sum / weight + pendant.shift < 0) {
          weight += pendant.conductance;
          sum -= static_cast<long double>(pendant.conductance) * pendant.shift;
        }
      long double best = sum / weight;
      if (grid.kind[at(k)] == CutPoint::bounded) best = std::max(best, 0.0L);
      change = std::max(change, std::abs(best - q[at(k)]));
      q[at(k)] = best;
    }
    if (change < 1e-18L) break;
  }
  return {q.begin(), q.end()};
}

double largest_difference(const CutGrid& grid, const std::vector<double>& p, const std::vector<double>& q) {
  double largest = 0;
  for (Index k = 0; k < grid.size(); ++k)
    if (grid.is_unknown(k))
      largest = std::max(largest, std::abs(p[static_cast<std::size_t>(k)] - q[static_cast<std::size_t>(k)]));
  return largest;
}

}  // namespace

TEST_CASE(
    "the enclosure holds the minimum of a grid, tightly, and also where values or sets were made wrong") {
  std::mt19937 random(17);
  for (const auto& [dimension, points] : {std::pair{std::size_t{1}, Index{33}}, {2, 17}, {3, 7}})
    for (int trial = 0; trial < 4; ++trial) {
      CAPTURE(dimension);
      CutGrid grid = tests::random_grid(dimension, points, random);
      const CutSolution found = convex::solve_cut_grids({&grid}).front();
      const std::vector<double> minimum = swept_minimum(grid);
      const double bound = convex::enclosed_error({&grid}, found);
      CHECK(largest_difference(grid, found.q, minimum) <= bound);
      CHECK(bound <= 1e-9);
      CutSolution moved = found, turned = found;
      for (Index k = 0; k < grid.size(); ++k) {
        if (grid.kind[static_cast<std::size_t>(k)] != CutPoint::bounded || random() % 4 != 0) continue;
        moved.q[static_cast<std::size_t>(k)] += 1e-3;
        std::uint8_t& held = turned.held[static_cast<std::size_t>(k)];
        held = held == 0;
        if (held != 0) turned.q[static_cast<std::size_t>(k)] = 0;
      }
      for (const CutSolution& wrong : {moved, turned}) {
        const double error = largest_difference(grid, wrong.q, minimum);
        CHECK(error > 1e-4);
        CHECK(error <= convex::enclosed_error({&grid}, wrong));
      }
    }
}

TEST_CASE("nothing is proved of a grid on which nothing pulls, nor of numbers that are none") {
  std::mt19937 random(18);
  CutGrid grid = tests::random_grid(2, 9, random);
  CutSolution found = convex::solve_cut_grids({&grid}).front();
  found.q[static_cast<std::size_t>(grid.at(4, 4))] = std::nan("");
  grid.kind[static_cast<std::size_t>(grid.at(4, 4))] = CutPoint::free;
  CHECK(std::isinf(convex::enclosed_error({&grid}, found)));
  std::fill(grid.pull.begin(), grid.pull.end(), 0.0);
  found.q.assign(found.q.size(), 0);
  CHECK(std::isinf(convex::enclosed_error({&grid}, found)));
}
