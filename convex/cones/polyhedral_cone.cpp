#include "convex/cones/polyhedral_cone.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "convex/cones/section_hull.hpp"
#include "convex/cones/strict_functional.hpp"
#include "convex/cones/verified_facets.hpp"
#include "convex/counted.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/invalid_input.hpp"
#include "convex/invariant.hpp"

namespace convex::inline cones {
namespace {

bool is_zero(const IntegerVector& v) {
  return std::all_of(v.begin(), v.end(), [](const Integer& entry) { return entry.is_zero(); });
}

/// Directions: a positive factor of a row says nothing.
IntegerRows directions(const ExactRows& rows, Index n, const char* what) {
  if (n < 1) throw InvalidInput("cone: no dimension; give vectors of at least one entry");
  IntegerRows made;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].size() != n)
      throw InvalidInput(std::string(what) + "[" + std::to_string(i) +
                         "]: " + counted(rows[i].size(), "entry", "entries") + "; give " + std::to_string(n));
    made.push_back(rows[i].numerators);
    make_primitive(made.back());
  }
  return made;
}

IntegerVector entries_at(const IntegerVector& v, const std::vector<std::size_t>& places) {
  IntegerVector chosen;
  for (std::size_t place : places) chosen.push_back(v[place]);
  return chosen;
}

/// K as the sum of its lineality space and a pointed cone in coordinates: those of the span's pivots.
struct PointedPart {
  Echelon lineality;
  Echelon span;                    ///< of the generators, 0 at the pivots of the lineality space
  IntegerVector y;                 ///< positive on every ray
  IntegerRows rays;                ///< distinct, primitive, in coordinates
  std::vector<std::size_t> input;  ///< which generator each is
};

PointedPart pointed_part(const IntegerRows& generators, const IntegerRows& lines, std::size_t n) {
  PointedPart part{echelon(lines, n), {}, {}, {}, {}};
  while (true) {
    part.rays.clear();
    part.input.clear();
    IntegerRows apart;  // from the lineality space
    for (std::size_t j = 0; j < generators.size(); ++j) {
      IntegerVector g = reduced(generators[j], part.lineality);
      if (is_zero(g)) continue;
      apart.push_back(std::move(g));
      part.input.push_back(j);
    }
    part.span = echelon(apart, n);
    if (apart.empty()) return part;
    for (const IntegerVector& g : apart) {
      part.rays.push_back(entries_at(g, part.span.pivots));
      make_primitive(part.rays.back());
    }
    StrictFunctional found = strict_functional(part.rays, part.span.rank());
    if (!found.y.empty()) {
      part.y = std::move(found.y);
      break;
    }
    for (std::size_t j : found.dependent) extend(part.lineality, apart[j]);
  }
  std::set<IntegerVector> seen;
  std::size_t kept = 0;
  for (std::size_t j = 0; j < part.rays.size(); ++j) {
    if (!seen.insert(part.rays[j]).second) continue;
    if (kept != j) part.rays[kept] = std::move(part.rays[j]);
    part.input[kept++] = part.input[j];
  }
  part.rays.resize(kept);
  part.input.resize(kept);
  return part;
}

Facets facets_of(const PointedPart& part) {
  const std::size_t r = part.span.rank();
  if (r == 0) return {};
  if (r == 1) {  // one ray; its facet is {0}
    invariant(part.rays.size() == 1, "distinct rays of a pointed cone on a line are one");
    return {{{-part.rays.front().front()}}, {{}}};
  }
  return verified_facets(part.rays, r, section_hull(part.rays, part.y));
}

/// The rays that no other ray shares all its facets with.
std::vector<std::size_t> extreme_rays(const Facets& facets, std::size_t rays) {
  std::vector<std::vector<std::size_t>> facets_of_ray(rays);
  for (std::size_t f = 0; f < facets.touching.size(); ++f)
    for (std::size_t k : facets.touching[f]) facets_of_ray[k].push_back(f);
  std::vector<std::size_t> extreme;
  for (std::size_t k = 0; k < rays; ++k) {
    // The face of a ray: those on all of its facets.
    std::size_t in_face = facets_of_ray[k].empty() ? rays : 0;
    if (!facets_of_ray[k].empty()) {
      std::vector<std::size_t> face = facets.touching[facets_of_ray[k].front()];
      for (std::size_t f : facets_of_ray[k]) {
        std::vector<std::size_t> both;
        std::set_intersection(face.begin(), face.end(), facets.touching[f].begin(), facets.touching[f].end(),
                              std::back_inserter(both));
        face = std::move(both);
        if (face.size() == 1) break;
      }
      in_face = face.size();
    }
    if (in_face == 1) extreme.push_back(k);
  }
  return extreme;
}

/// A covector of the coordinates as one of the space: 0 on the lineality space and off all pivots.
IntegerVector lifted(const IntegerVector& normal, const PointedPart& part, std::size_t n) {
  const Echelon& lineality = part.lineality;
  Integer multiple = 1;
  for (std::size_t k = 0; k < lineality.rank(); ++k) {
    const Integer& pivot = lineality.rows[k][lineality.pivots[k]];
    multiple *= exact_quotient(pivot, greatest_common_divisor(pivot, multiple));
  }
  IntegerVector a(n, 0);
  for (std::size_t i = 0; i < normal.size(); ++i) a[part.span.pivots[i]] = normal[i] * multiple;
  for (std::size_t k = 0; k < lineality.rank(); ++k) {
    Integer sum = 0;
    for (std::size_t pivot : part.span.pivots) sum += a[pivot] * lineality.rows[k][pivot];
    a[lineality.pivots[k]] = exact_quotient(-sum, lineality.rows[k][lineality.pivots[k]]);
  }
  make_primitive(a);
  return a;
}

PolyhedralCone cone_of(const IntegerRows& generators, const IntegerRows& lines, std::size_t n) {
  const PointedPart part = pointed_part(generators, lines, n);
  const Facets facets = facets_of(part);
  PolyhedralCone K;
  K.n = static_cast<Index>(n);
  K.lines = part.lineality.rows;
  for (std::size_t k : extreme_rays(facets, part.rays.size()))
    K.generators.push_back(generators[part.input[k]]);
  for (const IntegerVector& normal : facets.normals) K.halfspaces.push_back(lifted(normal, part, n));
  std::sort(K.halfspaces.begin(), K.halfspaces.end());
  Echelon span = part.lineality;
  for (const IntegerVector& row : part.span.rows) extend(span, row);
  K.equations = annihilator(span).rows;
  return K;
}

}  // namespace

PolyhedralCone generated_cone(const ExactRows& generators, const ExactRows& lines, Index n) {
  return cone_of(directions(generators, n, "generators"), directions(lines, n, "lines"),
                 static_cast<std::size_t>(n));
}

PolyhedralCone halfspace_cone(const ExactRows& halfspaces, const ExactRows& equations, Index n) {
  // The plain polar is generated by the normals, and polar of polar is the cone.
  PolyhedralCone K = cone_of(directions(halfspaces, n, "halfspaces"), directions(equations, n, "equations"),
                             static_cast<std::size_t>(n));
  std::swap(K.generators, K.halfspaces);
  std::swap(K.lines, K.equations);
  return K;
}

PolyhedralCone generated_cone(const Matrix& generators, const Matrix& lines) {
  return generated_cone(exact_rows(generators), exact_rows(lines), std::max(generators.cols(), lines.cols()));
}

PolyhedralCone halfspace_cone(const Matrix& halfspaces, const Matrix& equations) {
  return halfspace_cone(exact_rows(halfspaces), exact_rows(equations),
                        std::max(halfspaces.cols(), equations.cols()));
}

RowMatrix nearest_directions(const IntegerRows& rows, Index n) {
  RowMatrix M(static_cast<Index>(rows.size()), n);
  constexpr std::size_t double_bits = 53;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Integer scale = 1;
    bool exact = true;
    for (const Integer& entry : rows[i]) {
      const Integer size = entry.sign() < 0 ? -entry : entry;
      if (size > scale) scale = size;
      exact = exact && entry.bits() <= double_bits;
    }
    if (exact) scale = 1;
    for (Index j = 0; j < n; ++j)
      M(static_cast<Index>(i), j) = nearest_quotient(rows[i][static_cast<std::size_t>(j)], scale);
  }
  return M;
}

}  // namespace convex::inline cones
