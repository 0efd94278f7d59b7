#include "convex/cones/verified_facets.hpp"

#include <algorithm>
#include <map>
#include <string>

#include "convex/exact/elimination.hpp"
#include "convex/invariant.hpp"
#include "convex/vector.hpp"

namespace convex::inline cones {
namespace {

using Simplex = std::vector<std::size_t>;

std::vector<const IntegerVector*> corners(const IntegerRows& rays, const Simplex& simplex) {
  std::vector<const IntegerVector*> rows;
  for (std::size_t k : simplex) rows.push_back(&rays[k]);
  return rows;
}

/// The outward normal of the simplex's plane: one ray decides its sign, `touch_and_check` checks the others.
IntegerVector outward_normal(const IntegerRows& rays, std::size_t r, const Simplex& simplex) {
  IntegerVector normal = common_normal(corners(rays, simplex), r);
  invariant(!normal.empty(), "a simplex of a hull spans a plane");
  for (const IntegerVector& ray : rays) {
    const int side = dot(normal, ray).sign();
    if (side == 0) continue;
    if (side > 0)
      for (Integer& entry : normal) entry = -entry;
    return normal;
  }
  invariant(false, "rays of a cone with interior do not lie in one plane");
  return normal;
}

RowMatrix rounded(const IntegerRows& rows, std::size_t r) {
  RowMatrix M(static_cast<Index>(rows.size()), static_cast<Index>(r));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < r; ++j)
      M(static_cast<Index>(i), static_cast<Index>(j)) = nearest_quotient(rows[i][j], 1);
  return M;
}

/// Every ray is on the inner side of every facet: by doubles where their rounding bound (Higham 2002, (3.5),
/// with that of the data) leaves no doubt, else exactly.
std::vector<Simplex> touch_and_check(const IntegerRows& rays, const IntegerRows& normals, std::size_t r) {
  const RowMatrix N = rounded(normals, r), G = rounded(rays, r);
  const Matrix products = G * N.transpose();
  const double gamma = 2 * (static_cast<double>(r) + 4) * unit_roundoff;
  const Vector ray_lengths = G.rowwise().norm(), normal_lengths = N.rowwise().norm();
  std::vector<Simplex> touching(normals.size());
  for (std::size_t f = 0; f < normals.size(); ++f)
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const auto row = static_cast<Index>(k), column = static_cast<Index>(f);
      if (products(row, column) < -gamma * ray_lengths[row] * normal_lengths[column]) continue;
      const int side = dot(normals[f], rays[k]).sign();
      invariant(side <= 0, "every generator satisfies every half-space");
      if (side == 0) touching[f].push_back(k);
    }
  return touching;
}

/// The ridges are strings of indices: short ones are held in place.
template <class Text>
bool every_ridge_is_in_two(const std::vector<Simplex>& simplices) {
  std::vector<Text> ridges;
  ridges.reserve(simplices.size() * simplices.front().size());
  for (const Simplex& simplex : simplices) {
    Text corners;
    for (std::size_t k : simplex) corners.push_back(static_cast<typename Text::value_type>(k));
    for (std::size_t left_out = 0; left_out < simplex.size(); ++left_out) {
      ridges.push_back(corners);
      ridges.back().erase(left_out, 1);
    }
  }
  std::sort(ridges.begin(), ridges.end());
  if (ridges.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < ridges.size(); i += 2)
    if (ridges[i] != ridges[i + 1] || (i + 2 < ridges.size() && ridges[i + 2] == ridges[i])) return false;
  return true;
}

/// Whether the point is in the cone of the simplex: each plane through the other corners and a vector off the
/// facet has it on the side of the corner left out.
bool covers(const IntegerRows& rays, std::size_t r, const Simplex& simplex, const IntegerVector& off_facet,
            const IntegerVector& point) {
  for (std::size_t left_out = 0; left_out < simplex.size(); ++left_out) {
    std::vector<const IntegerVector*> rows = corners(rays, simplex);
    const IntegerVector* corner = rows[left_out];
    rows[left_out] = &off_facet;
    const IntegerVector plane = common_normal(rows, r);
    if (dot(plane, *corner).sign() * dot(plane, point).sign() < 0) return false;
  }
  return true;
}

}  // namespace

Facets verified_facets(const IntegerRows& rays, std::size_t r, const std::vector<Simplex>& simplices) {
  invariant(!simplices.empty(), "a section of a pointed cone has a boundary");
  std::map<IntegerVector, Simplex> planes;  // to the simplices in it
  for (std::size_t s = 0; s < simplices.size(); ++s) {
    invariant(simplices[s].size() == r - 1, "a simplex of a hull has r - 1 corners");
    planes[outward_normal(rays, r, simplices[s])].push_back(s);
  }
  Facets facets;
  for (const auto& [normal, members] : planes) facets.normals.push_back(normal);
  facets.touching = touch_and_check(rays, facets.normals, r);
  invariant(rays.size() <= 0x10000 ? every_ridge_is_in_two<std::u16string>(simplices)
                                   : every_ridge_is_in_two<std::u32string>(simplices),
            "every ridge lies in exactly two facets");
  const auto plane = std::min_element(planes.begin(), planes.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
  IntegerVector middle(r, 0);
  for (std::size_t k : simplices[plane->second.front()])
    for (std::size_t i = 0; i < r; ++i) middle[i] += rays[k][i];
  const auto times_covered = std::count_if(plane->second.begin(), plane->second.end(), [&](std::size_t s) {
    return covers(rays, r, simplices[s], plane->first, middle);
  });
  invariant(times_covered == 1, "the ray through the middle of a simplex meets no other");
  return facets;
}

}  // namespace convex::inline cones
