#include "convex/cones/cone_faces.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "convex/cones/cone_operations.hpp"
#include "convex/exact/elimination.hpp"

namespace convex::inline cones {
namespace {

using Indices = std::vector<Index>;

Indices all(std::size_t count) {
  Indices indices(count);
  std::iota(indices.begin(), indices.end(), Index{0});
  return indices;
}

bool at_right_angles(const IntegerVector& a, const IntegerVector& x) { return dot(a, x).is_zero(); }

/// For each half-space the generators on it.
std::vector<Indices> touching(const PolyhedralCone& K) {
  std::vector<Indices> lists(K.halfspaces.size());
  for (std::size_t h = 0; h < K.halfspaces.size(); ++h)
    for (std::size_t k = 0; k < K.generators.size(); ++k)
      if (at_right_angles(K.halfspaces[h], K.generators[k])) lists[h].push_back(static_cast<Index>(k));
  return lists;
}

/// From the half-spaces of a face to its generators.
using Level = std::map<Indices, Indices>;

/// The smallest faces above one: a generator outside takes away half-spaces; those generators that take away
/// no more than another does span the next face with it.
void add_covers(const Indices& halfspaces, const Indices& generators, const std::vector<Indices>& touching,
                Level& above) {
  std::map<Index, Indices> left;  // generator outside, half-spaces that remain
  for (Index h : halfspaces)
    for (Index k : touching[static_cast<std::size_t>(h)])
      if (!std::binary_search(generators.begin(), generators.end(), k)) left[k].push_back(h);
  Level groups;
  for (const auto& [k, remaining] : left) groups[remaining].push_back(k);
  std::vector<const Level::value_type*> largest_first;
  for (const auto& group : groups) largest_first.push_back(&group);
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [](const auto* a, const auto* b) { return a->first.size() > b->first.size(); });
  std::vector<const Indices*> covers;
  for (const auto* group : largest_first) {
    const Indices& remaining = group->first;
    const bool beyond = std::any_of(covers.begin(), covers.end(), [&](const Indices* cover) {
      return std::includes(cover->begin(), cover->end(), remaining.begin(), remaining.end());
    });
    if (beyond) continue;
    covers.push_back(&remaining);
    Indices members;
    std::merge(generators.begin(), generators.end(), group->second.begin(), group->second.end(),
               std::back_inserter(members));
    above.emplace(remaining, std::move(members));
  }
}

}  // namespace

std::optional<ConeFace> face_of(const PolyhedralCone& K, const ExactVector& x) {
  if (!contains(K, x)) return std::nullopt;
  ConeFace face;
  for (std::size_t h = 0; h < K.halfspaces.size(); ++h)
    if (at_right_angles(K.halfspaces[h], x.numerators)) face.halfspaces.push_back(static_cast<Index>(h));
  IntegerRows spanning = K.lines;
  for (std::size_t k = 0; k < K.generators.size(); ++k) {
    const IntegerVector& g = K.generators[k];
    if (std::all_of(face.halfspaces.begin(), face.halfspaces.end(),
                    [&](Index h) { return at_right_angles(K.halfspaces[static_cast<std::size_t>(h)], g); })) {
      face.generators.push_back(static_cast<Index>(k));
      spanning.push_back(g);
    }
  }
  face.dimension = static_cast<Index>(echelon(spanning, static_cast<std::size_t>(K.n)).rank());
  return face;
}

std::vector<std::vector<ConeFace>> faces(const PolyhedralCone& K) {
  const std::vector<Indices> on = touching(K);
  const auto levels = static_cast<std::size_t>(K.dimension() - K.lineality());
  std::vector<std::vector<ConeFace>> found(levels + 1);
  Level level{{all(K.halfspaces.size()), {}}};
  for (std::size_t k = 0; k < levels; ++k) {
    Level above;
    for (const auto& [halfspaces, generators] : level) {
      found[k].push_back({K.lineality() + static_cast<Index>(k), generators, halfspaces});
      add_covers(halfspaces, generators, on, above);
    }
    level = std::move(above);
  }
  found[levels].push_back({K.dimension(), all(K.generators.size()), {}});
  for (auto& same_dimension : found)
    std::sort(same_dimension.begin(), same_dimension.end(),
              [](const ConeFace& a, const ConeFace& b) { return a.generators < b.generators; });
  return found;
}

std::vector<Index> f_vector(const PolyhedralCone& K) {
  std::vector<Index> counts(static_cast<std::size_t>(K.lineality()), 0);
  for (const auto& same_dimension : faces(K)) counts.push_back(static_cast<Index>(same_dimension.size()));
  return counts;
}

}  // namespace convex::inline cones
