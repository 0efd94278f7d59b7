#include "convex/obstacle_problem/cut_multigrid.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "convex/obstacle_problem/cut_edge.hpp"
#include "tests/convex/obstacle_problem/random_grid.hpp"

using convex::CutEquations;
using convex::CutGrid;
using convex::CutMultigrid;
using convex::CutPoint;
using convex::Index;

namespace {

std::size_t at(Index k) { return static_cast<std::size_t>(k); }

}  // namespace

TEST_CASE("corrections in floats end at the rounding of doubles, whatever the sizes of links and loads") {
  std::mt19937 random(5);
  for (const double link_size : {1.0, 1e-60, 1e60})
    for (const double load_size : {1.0, 1e-90, 1e90})
      for (const auto& [dimension, points] : {std::pair{std::size_t{1}, Index{33}}, {2, 17}, {3, 9}}) {
        CAPTURE(link_size);
        CAPTURE(load_size);
        CAPTURE(dimension);
        CutGrid fine = tests::random_grid(dimension, points, random);
        CutGrid coarse = tests::random_grid(dimension, (points + 1) / 2, random);
        for (CutGrid* grid : {&fine, &coarse}) {
          for (std::vector<double>* field : {&grid->link[0], &grid->link[1], &grid->link[2], &grid->pull})
            for (double& one : *field) one *= link_size;
          for (double& one : grid->load) one *= load_size;
        }
        const CutEquations equations(fine);
        CutMultigrid multigrid({&fine, &coarse});
        multigrid.set_free(std::vector<std::uint8_t>(at(fine.size())),
                           std::vector<std::uint8_t>(fine.pendants.size()));
        std::vector<double> q(at(fine.size()));
        multigrid.correct(equations, q, 0);
        double largest = 0;
        for (const double one : q) largest = std::max(largest, std::abs(one));
        for (Index k = 0; k < fine.size(); ++k)
          if (fine.is_unknown(k))
            CHECK(std::abs(equations.push(q, k)) <= 1e-14 * largest * equations.diagonal(k) + 1e-300);
      }
}

TEST_CASE("sweeps around an edge leave points away from it as they are, and hold those that end at 0") {
  constexpr Index points = 65;
  constexpr int sweeps = 16;
  CutGrid grid(2, {points, points, 1});
  std::vector<double> q(at(grid.size()));
  std::vector<std::uint8_t> held(at(grid.size()));
  for (Index j = 0; j < points; ++j)
    for (Index i = 0; i < points; ++i) {
      const Index k = grid.at(i, j);
      grid.kind[at(k)] = CutPoint::bounded;
      if (i + 1 < points) grid.link[0][at(k)] = 1;
      if (j + 1 < points) grid.link[1][at(k)] = 1;
      grid.load[at(k)] = -0.02;
      held[at(k)] = i < 20;
      q[at(k)] = i < 20 ? 0 : 1e-3 * static_cast<double>(i - 20);  // too low: its edge is further on
    }
  const std::vector<double> before = q;
  convex::relax_edge(CutEquations(grid), sweeps, held, q);
  Index moved = 0;
  for (Index j = 0; j < points; ++j)
    for (Index i = 0; i < points; ++i) {
      const auto k = at(grid.at(i, j));
      if (std::abs(2 * i - 39) > sweeps + 1) CHECK(q[k] == before[k]);
      CHECK((held[k] != 0) == (q[k] == 0));
      moved += held[k] != 0 && i >= 20;
    }
  CHECK(moved >= 3 * points);
}

TEST_CASE(
    "held points with edges between those of coarse grids cost a cycle or two more than none, on grids of "
    "any size") {
  // Fixed on the border; a load of 1 inside.
  const auto square = [](Index points) {
    CutGrid grid(2, {points, points, 1});
    for (Index j = 0; j < points; ++j)
      for (Index i = 0; i < points; ++i)
        grid.kind[at(grid.at(i, j))] =
            std::min({i, j, points - 1 - i, points - 1 - j}) == 0 ? CutPoint::fixed : CutPoint::bounded;
    for (Index k = 0; k < grid.size(); ++k) {
      if (!grid.is_unknown(k)) continue;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const Index before = k - grid.stride(axis), behind = k + grid.stride(axis);
        if (grid.is_unknown(behind)) grid.link[axis][at(k)] = 1;
        grid.pull[at(k)] += !grid.is_unknown(before) + !grid.is_unknown(behind);
      }
      grid.load[at(k)] = 1;
    }
    return grid;
  };
  const auto cycles = [&](Index points, double radius) {
    std::vector<CutGrid> grids;
    for (Index n = points; n >= 5; n = (n + 1) / 2) grids.push_back(square(n));
    std::vector<const CutGrid*> nested;
    for (const CutGrid& grid : grids) nested.push_back(&grid);
    const CutGrid& finest = grids.front();
    CutMultigrid multigrid(nested);
    std::vector<std::uint8_t> held(at(finest.size()));
    const double half = 0.5 * static_cast<double>(points - 1);
    for (Index j = 0; j < points; ++j)
      for (Index i = 0; i < points; ++i)
        held[at(finest.at(i, j))] =
            std::hypot(static_cast<double>(i) - half, static_cast<double>(j) - half) < radius * half;
    multigrid.set_free(held, {});
    std::vector<double> q(at(finest.size()));
    return multigrid.correct(CutEquations(finest), q, 1e-6);
  };
  for (const Index points : {65, 129, 257, 513})
    for (const double radius : {0.2237, 0.5, 0.71}) {
      CAPTURE(points);
      CAPTURE(radius);
      CHECK(cycles(points, radius) <= cycles(points, 0) + 1);
    }
}
