#include <algorithm>
#include <cmath>

#include "convex/nearest_point/gallery/families.hpp"
#include "convex/nearest_point/gallery/planted.hpp"

namespace convex::inline families {
namespace {

Index part_of(Index n, double part) {
  return std::clamp<Index>(static_cast<Index>(std::lround(part * static_cast<double>(n))), 0, n);
}

/// The nearest power of two: a factor that leaves all bits as they are.
double dyadic(double value) {
  return value > 0 ? std::ldexp(1.0, static_cast<int>(std::lround(std::log2(value)))) : 0;
}

PlantedRows start(Index n, Draw& draw) {
  Matrix A = integer_inertia(n, draw);
  return {std::move(A), draw.integers(n, -8, 8)};
}

void add_loaded(PlantedRows& rows, Index count, Index n, Draw& draw) {
  for (Index a = 0; a < count; ++a) {
    const Vector u = integer_row(n, draw);
    rows.add(u, draw.integer(1, 16), 0);
  }
}

}  // namespace

GalleryInstance well_posed(Index n, double part_held, std::uint32_t seed) {
  Draw draw(seed);
  PlantedRows rows = start(n, draw);
  add_loaded(rows, part_of(n, part_held), n, draw);
  rows.add_apart(2 * n - rows.count(), draw);
  return rows.instance(draw);
}

GalleryInstance redundant(Index n, double sums_per_row, std::uint32_t seed) {
  Draw draw(seed);
  PlantedRows rows = start(n, draw);
  const Index held = n / 2;
  add_loaded(rows, held, n, draw);
  const auto sums = static_cast<Index>(std::lround(sums_per_row * static_cast<double>(held)));
  for (Index a = 0; a < sums; ++a) {
    const Vector u = draw.integer(1, 2) * rows.row(draw.index(held)) + rows.row(draw.index(held));
    rows.add(u, draw.integer(0, 4), 0);
  }
  rows.add_apart(n / 2, draw);
  return rows.instance(draw);
}

GalleryInstance repeated(Index n, double copies, std::uint32_t seed) {
  Draw draw(seed);
  PlantedRows rows = start(n, draw);
  const Index held = n / 2;
  add_loaded(rows, held, n, draw);
  const auto times = static_cast<Index>(std::lround(copies));
  for (Index copy = 0; copy < times; ++copy)
    for (Index a = 0; a < held; ++a) {
      const Vector u = rows.row(a);
      rows.add(u, draw.integer(0, 4), 0);
    }
  rows.add_apart(n / 2, draw);
  return rows.instance(draw);
}

GalleryInstance no_interior(Index n, double part, std::uint32_t seed) {
  Draw draw(seed);
  PlantedRows rows = start(n, draw);
  const Index groups = std::max<Index>(1, part_of(n / 2, part));
  for (Index group = 0; group < groups; ++group) {
    const Vector u = integer_row(n, draw), v = integer_row(n, draw), last = -(u + v);
    rows.add(u, draw.integer(0, 8), 0);
    rows.add(v, draw.integer(0, 8), 0);
    rows.add(last, draw.integer(0, 8), 0);
  }
  rows.add_apart(n, draw);
  return rows.instance(draw);
}

GalleryInstance weakly_active(Index n, double slack, std::uint32_t seed) {
  Draw draw(seed);
  PlantedRows rows = start(n, draw);
  const Index third = std::max<Index>(1, n / 3);
  add_loaded(rows, third, n, draw);
  for (Index a = 0; a < third; ++a) {
    const Vector u = integer_row(n, draw);
    rows.add(u, 0, dyadic(slack));
  }
  rows.add_apart(n, draw);
  return rows.instance(draw);
}

GalleryInstance tall(Index n, double rows_per_coordinate, std::uint32_t seed) {
  Draw draw(seed);
  PlantedRows rows = start(n, draw);
  add_loaded(rows, n / 2, n, draw);
  const auto all = static_cast<Index>(std::lround(rows_per_coordinate * static_cast<double>(n)));
  rows.add_apart(all - rows.count(), draw);
  return rows.instance(draw);
}

GalleryInstance scaled(Index n, double unit, std::uint32_t seed) {
  GalleryInstance instance = well_posed(n, 0.5, seed);
  const double factor = dyadic(unit);
  instance.problem.z *= factor;
  instance.problem.s *= factor;
  instance.solution.hi *= factor;
  instance.multipliers *= factor;
  return instance;
}

GalleryInstance infeasible(Index n, double margin, std::uint32_t seed) {
  Draw draw(seed);
  PlantedRows rows = start(n, draw);
  const Vector u = integer_row(n, draw), v = integer_row(n, draw), last = -(u + v);
  // A weight marks the rows that exclude each other; `instance` carries it through the shuffle.
  rows.add(u, 1, 0);
  rows.add(v, 1, 0);
  rows.add(last, 1, -dyadic(margin));
  rows.add_apart(2 * n, draw);
  GalleryInstance instance = rows.instance(draw);
  instance.feasible = false;
  instance.farkas = instance.multipliers;
  instance.multipliers.resize(0);
  instance.solution = DoubleDoubleVector(0);
  return instance;
}

}  // namespace convex::inline families
