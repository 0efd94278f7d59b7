#include "convex/atlas/simplicial_pieces.hpp"

#include <algorithm>
#include <cstdint>
#include <map>

#include "convex/exact/elimination.hpp"

namespace convex::atlas {
namespace {

Places common(const Places& a, const Places& b) {
  Places both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

bool is_part(const Places& part, const Places& whole) {
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

bool is_vertex(const IntegerVector& g) { return g.back().sign() > 0; }

/// From a vertex along an edge whose other end is a vertex, or a ray.
IntegerVector edge(const IntegerVector& vertex, const IntegerVector& other) {
  IntegerVector direction;
  for (std::size_t i = 0; i + 1 < vertex.size(); ++i)
    direction.push_back(is_vertex(other) ? other[i] * vertex.back() - vertex[i] * other.back() : other[i]);
  make_primitive(direction);
  return direction;
}

/// A functional that increases on every ray and is constant on no edge: a positive combination of the inward
/// normals, with other weights until it is so.
IntegerVector rising_functional(const PolyhedralCone& cone, const IntegerRows& edges) {
  std::uint32_t state = 1;
  IntegerVector rising(static_cast<std::size_t>(cone.n - 1), 0);
  const auto is_constant = [&](const IntegerVector& e) { return dot(rising, e).is_zero(); };
  do {
    std::fill(rising.begin(), rising.end(), Integer{0});
    for (const IntegerVector& a : cone.halfspaces) {
      state = state * 1664525U + 1013904223U;
      const auto weight = static_cast<std::int64_t>(1 + (state >> 20U));
      for (std::size_t i = 0; i < rising.size(); ++i) rising[i] -= a[i] * weight;
    }
  } while (std::any_of(edges.begin(), edges.end(), is_constant));
  return rising;
}

}  // namespace

std::vector<Places> simplicial_pieces(const Places& generators, const std::vector<Places>& facets,
                                      std::size_t dimension) {
  if (generators.size() == dimension) return {generators};
  std::vector<Places> faces;  // of this cone: the largest intersections with facets of the whole
  for (const Places& facet : facets) {
    Places part = common(generators, facet);
    if (part.size() == generators.size()) continue;
    if (std::any_of(faces.begin(), faces.end(), [&](const Places& other) { return is_part(part, other); }))
      continue;
    std::erase_if(faces, [&](const Places& other) { return is_part(other, part); });
    faces.push_back(std::move(part));
  }
  std::vector<Places> pieces;
  for (const Places& part : faces) {
    if (part.empty() || part.front() == generators.front()) continue;
    for (Places& piece : simplicial_pieces(part, facets, dimension - 1)) {
      piece.insert(piece.begin(), generators.front());
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

std::vector<SignedCone> signed_cones(const PolyhedralCone& cone,
                                     const std::vector<std::vector<ConeFace>>& levels, const ConeFace& face) {
  struct Edge {
    IntegerVector direction;
    const ConeFace* face;
  };
  std::map<Index, std::vector<Edge>> edges;  // by vertex
  IntegerRows all;
  const auto dimension = static_cast<std::size_t>(face.dimension - cone.lineality() - 1);
  if (dimension >= 1)
    for (const ConeFace& two : levels[2]) {
      if (!std::includes(face.generators.begin(), face.generators.end(), two.generators.begin(),
                         two.generators.end()))
        continue;
      for (const std::size_t here : {std::size_t{0}, std::size_t{1}}) {
        const Index vertex = two.generators[here];
        const IntegerVector& from = cone.generators[at(vertex)];
        if (!is_vertex(from)) continue;
        Edge found{edge(from, cone.generators[at(two.generators[1 - here])]), &two};
        all.push_back(found.direction);
        edges[vertex].push_back(std::move(found));
      }
    }
  const IntegerVector rising = rising_functional(cone, all);
  std::vector<SignedCone> made;
  for (const Index vertex : face.generators) {
    const IntegerVector& from = cone.generators[at(vertex)];
    if (!is_vertex(from)) continue;
    const std::vector<Edge>& here = edges[vertex];
    Places generators;
    for (std::size_t k = 0; k < here.size(); ++k) generators.push_back(k);
    std::vector<Places> facets;
    for (std::size_t h = 0; h < cone.halfspaces.size(); ++h) {
      facets.emplace_back();
      for (std::size_t k = 0; k < here.size(); ++k)
        if (std::binary_search(here[k].face->halfspaces.begin(), here[k].face->halfspaces.end(),
                               static_cast<Index>(h)))
          facets.back().push_back(k);
    }
    const ExactVector apex{IntegerVector(from.begin(), from.end() - 1), from.back()};
    for (const Places& piece : simplicial_pieces(generators, facets, dimension)) {
      SignedCone one{1, apex, {}};
      for (const std::size_t k : piece) {
        one.directions.push_back(here[k].direction);
        if (dot(rising, here[k].direction).sign() > 0) continue;
        one.sign = -one.sign;
        for (Integer& entry : one.directions.back()) entry = -entry;
      }
      made.push_back(std::move(one));
    }
  }
  return made;
}

}  // namespace convex::atlas
