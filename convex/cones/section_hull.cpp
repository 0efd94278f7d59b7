#include "convex/cones/section_hull.hpp"

#include <CGAL/Epeck_d.h>
#include <CGAL/Triangulation.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/exact/elimination.hpp"

namespace convex {
namespace {

using Kernel = CGAL::Epeck_d<CGAL::Dynamic_dimension_tag>;
using Structure =
    CGAL::Triangulation_data_structure<Kernel::Dimension, CGAL::Triangulation_vertex<Kernel, std::size_t>,
                                       CGAL::Triangulation_full_cell<Kernel>>;
using Triangulation = CGAL::Triangulation<Kernel, Structure>;
using Number = Kernel::FT;
using Exact = CGAL::internal::Exact_field_selector<double>::Type;

Exact exact(const Integer& a) { return a.fits_word() ? Exact(static_cast<long>(a.word())) : Exact(a.text()); }

/// ray / (y·ray) without the coordinate that the others determine.
Kernel::Point_d section_point(const IntegerVector& ray, const Exact& height, std::size_t dropped) {
  std::vector<Number> coordinates;
  for (std::size_t i = 0; i < ray.size(); ++i)
    if (i != dropped) coordinates.emplace_back(Exact(exact(ray[i]) / height));
  return Kernel::Point_d(static_cast<int>(coordinates.size()), coordinates.begin(), coordinates.end());
}

/// Farthest from the middle first, in each coordinate's own scale: what comes later is then mostly inside,
/// and costs nothing but a walk.
std::vector<std::size_t> outer_first(const IntegerRows& rays, const std::vector<Integer>& heights) {
  std::vector<double> distance(rays.size(), 0);
  for (std::size_t i = 0; i < rays.front().size(); ++i) {
    std::vector<double> entry;
    for (std::size_t k = 0; k < rays.size(); ++k) entry.push_back(nearest_quotient(rays[k][i], heights[k]));
    const double mean = std::accumulate(entry.begin(), entry.end(), 0.0) / static_cast<double>(entry.size());
    double spread = 0;
    for (double value : entry) spread += (value - mean) * (value - mean);
    if (!(spread > 0) || !std::isfinite(spread)) continue;
    for (std::size_t k = 0; k < rays.size(); ++k)
      distance[k] += (entry[k] - mean) * (entry[k] - mean) / spread;
  }
  std::vector<std::size_t> order(rays.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return distance[a] > distance[b]; });
  return order;
}

}  // namespace

std::vector<std::vector<std::size_t>> section_hull(const IntegerRows& rays, const IntegerVector& y) {
  const std::size_t r = y.size();
  const auto dropped = static_cast<std::size_t>(
      std::find_if(y.begin(), y.end(), [](const Integer& entry) { return !entry.is_zero(); }) - y.begin());
  std::vector<Integer> heights;
  for (const IntegerVector& ray : rays) heights.push_back(dot(y, ray));
  const int dimension = static_cast<int>(r) - 1;
  Triangulation triangulation(dimension);
  Triangulation::Full_cell_handle nearby;
  for (std::size_t k : outer_first(rays, heights)) {
    const Kernel::Point_d point = section_point(rays[k], exact(heights[k]), dropped);
    Triangulation::Locate_type where{};
    Triangulation::Face face(dimension);
    Triangulation::Facet facet;
    const auto cell = triangulation.locate(point, where, face, facet, nearby);
    if (where != Triangulation::OUTSIDE_CONVEX_HULL && where != Triangulation::OUTSIDE_AFFINE_HULL) continue;
    const auto vertex = triangulation.insert(point, where, face, facet, cell);
    vertex->data() = k;
    nearby = vertex->full_cell();
  }
  std::vector<std::vector<std::size_t>> simplices;
  for (auto cell = triangulation.full_cells_begin(); cell != triangulation.full_cells_end(); ++cell) {
    if (!triangulation.is_infinite(cell)) continue;
    std::vector<std::size_t> simplex;
    for (int i = 0; i <= triangulation.current_dimension(); ++i)
      if (!triangulation.is_infinite(cell->vertex(i))) simplex.push_back(cell->vertex(i)->data());
    std::sort(simplex.begin(), simplex.end());
    simplices.push_back(std::move(simplex));
  }
  return simplices;
}

}  // namespace convex
