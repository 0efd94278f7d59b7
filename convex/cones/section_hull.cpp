#include "convex/cones/section_hull.hpp"

#include <CGAL/Dimension.h>
#include <CGAL/Triangulation.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "convex/exact/determinant_sign.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/invariant.hpp"

namespace convex::inline cones {
namespace {

/// What CGAL's triangulation asks of its points, answered for the points where rays meet a section of their
/// cone: an orientation is the sign of the determinant of the rays themselves, as their heights are positive.
/// A point is the number of its ray. The first r points are independent, so that the questions about points
/// within a common plane never arise.
struct RayTraits {
  using Dimension = CGAL::Dynamic_dimension_tag;
  using Point_d = std::size_t;

  struct Orientation_d {
    const DeterminantSign* sign;
    template <class Iterator>
    CGAL::Orientation operator()(Iterator first, Iterator last) const {
      thread_local std::vector<std::size_t> chosen;
      chosen.assign(first, last);
      return static_cast<CGAL::Orientation>((*sign)(chosen));
    }
  };
  struct Flat_orientation_d {};
  struct Construct_flat_orientation_d {
    template <class Iterator>
    Flat_orientation_d operator()(Iterator, Iterator) const {
      return {};
    }
  };
  /// Asked for the simplex that defines the orientation only.
  struct In_flat_orientation_d {
    template <class Iterator>
    CGAL::Orientation operator()(const Flat_orientation_d&, Iterator, Iterator) const {
      return CGAL::POSITIVE;
    }
  };
  struct Contained_in_affine_hull_d {
    template <class Iterator>
    bool operator()(Iterator, Iterator, const Point_d&) const {
      invariant(false, "a hull that starts with a simplex is never flat");
      return false;
    }
  };
  struct Compare_lexicographically_d {
    CGAL::Comparison_result operator()(const Point_d& a, const Point_d& b) const {
      return a < b ? CGAL::SMALLER : a > b ? CGAL::LARGER : CGAL::EQUAL;
    }
  };

  Orientation_d orientation_d_object() const { return {sign}; }
  Construct_flat_orientation_d construct_flat_orientation_d_object() const { return {}; }
  In_flat_orientation_d in_flat_orientation_d_object() const { return {}; }
  Contained_in_affine_hull_d contained_in_affine_hull_d_object() const { return {}; }
  Compare_lexicographically_d compare_lexicographically_d_object() const { return {}; }

  const DeterminantSign* sign = nullptr;
};

using Triangulation = CGAL::Triangulation<RayTraits>;

/// Farthest from the middle of the section first, in each coordinate's own scale: what comes later is then
/// mostly inside, and costs nothing but a walk.
std::vector<std::size_t> outer_first(const IntegerRows& rays, const IntegerVector& y) {
  std::vector<double> distance(rays.size(), 0);
  std::vector<Integer> heights;
  for (const IntegerVector& ray : rays) heights.push_back(dot(y, ray));
  for (std::size_t i = 0; i < y.size(); ++i) {
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

/// The first r independent ones to the front.
void simplex_first(std::vector<std::size_t>& order, const IntegerRows& rays, std::size_t r) {
  Echelon span{r, {}, {}};
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t k) { return span.rank() < r && extend(span, rays[k]); });
  invariant(span.rank() == r, "the rays span the space");
}

}  // namespace

std::vector<std::vector<std::size_t>> section_hull(const IntegerRows& rays, const IntegerVector& y) {
  const std::size_t r = y.size();
  const int dimension = static_cast<int>(r) - 1;
  std::vector<std::size_t> order = outer_first(rays, y);
  simplex_first(order, rays, r);
  const DeterminantSign sign(rays, r);
  Triangulation triangulation(dimension, RayTraits{&sign});
  Triangulation::Full_cell_handle nearby;
  for (std::size_t k : order) {
    if (triangulation.current_dimension() < dimension) {
      triangulation.insert_outside_affine_hull(k);
      continue;
    }
    Triangulation::Locate_type where{};
    Triangulation::Face face(dimension);
    Triangulation::Facet facet;
    const auto cell = triangulation.locate(k, where, face, facet, nearby);
    if (where == Triangulation::OUTSIDE_CONVEX_HULL)
      nearby = triangulation.insert_outside_convex_hull(k, cell)->full_cell();
  }
  std::vector<std::vector<std::size_t>> simplices;
  for (auto cell = triangulation.full_cells_begin(); cell != triangulation.full_cells_end(); ++cell) {
    if (!triangulation.is_infinite(cell)) continue;
    std::vector<std::size_t> simplex;
    for (int i = 0; i <= dimension; ++i)
      if (!triangulation.is_infinite(cell->vertex(i))) simplex.push_back(cell->vertex(i)->point());
    std::sort(simplex.begin(), simplex.end());
    simplices.push_back(std::move(simplex));
  }
  return simplices;
}

}  // namespace convex::inline cones
