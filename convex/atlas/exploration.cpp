#include <algorithm>
#include <map>
#include <set>

#include "convex/atlas/atlas.hpp"
#include "convex/cones/strict_functional.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"

namespace convex::atlas {
namespace {

using Rows = std::vector<std::size_t>;

IntegerVector inner_products(const IntegerRows& rows, const IntegerVector& v) {
  IntegerVector products;
  for (const IntegerVector& row : rows) products.push_back(dot(row, v));
  return products;
}

bool is_null(const IntegerVector& v) {
  return std::all_of(v.begin(), v.end(), [](const Integer& entry) { return entry.is_zero(); });
}

/// All rows that have equality where these have, if the points where they have are a face of the polyhedron
/// with no other row tight: some point has the rest strictly. None otherwise.
std::optional<Rows> closed_face(const RowSpace& space, const Rows& rows) {
  const std::size_t columns = space.rank + 1;
  IntegerRows held;
  for (const std::size_t a : rows) held.push_back(space.rows[a]);
  const IntegerRows plane = annihilator(echelon(held, columns)).rows;
  Rows tight;
  IntegerRows rest;
  for (std::size_t a = 0; a < space.count(); ++a) {
    IntegerVector form = inner_products(plane, space.rows[a]);
    if (is_null(form))
      tight.push_back(a);
    else if (space.two_sided[a])
      return std::nullopt;
    else
      rest.push_back(std::move(form));
  }
  IntegerVector ahead;
  for (const IntegerVector& direction : plane) ahead.push_back(direction.back());
  if (is_null(ahead)) return std::nullopt;
  rest.push_back(std::move(ahead));
  if (strict_functional(rest, plane.size()).y.empty()) return std::nullopt;
  return tight;
}

class Explorer {
 public:
  explicit Explorer(RowSpace space) : made_{std::move(space), {}, {}, false, 0} {}

  Atlas from(const Rows& rows, std::size_t most) {
    index(rows);
    for (; made_.explored < std::min(most, made_.cells.size()); ++made_.explored) {
      const std::size_t here = made_.explored;
      const Rows held = made_.cells[here].rows;
      for (const Rows& tighter : tighter_than(held)) join(index(tighter), here);
      for (const Rows& looser : looser_than(held)) join(here, index(looser));
    }
    return std::move(made_);
  }

 private:
  std::size_t index(const Rows& rows) {
    const auto [found, is_new] = places_.emplace(rows, made_.cells.size());
    if (is_new) {
      Cell cell;
      cell.rows = rows;
      cell.freedom = made_.space.n - static_cast<Index>(independent(made_.space, rows).size());
      made_.cells.push_back(std::move(cell));
    }
    return found->second;
  }

  /// One more row has equality.
  std::set<Rows> tighter_than(const Rows& rows) const {
    std::set<Rows> found;
    for (std::size_t a = 0; a < made_.space.count(); ++a) {
      if (std::binary_search(rows.begin(), rows.end(), a)) continue;
      Rows more = rows;
      more.push_back(a);
      if (auto tight = closed_face(made_.space, more)) found.insert(std::move(*tight));
    }
    return found;
  }

  /// The facets of the cone of the rows.
  std::set<Rows> looser_than(const Rows& rows) const {
    std::set<Rows> found;
    const RowSpace& space = made_.space;
    if (rows.empty()) return found;
    const auto normal = [&](std::size_t a) {
      return IntegerVector(space.rows[a].begin(), space.rows[a].end() - 1);
    };
    ExactRows one_sided, lines;
    for (const std::size_t a : rows) (space.two_sided[a] ? lines : one_sided).push_back({normal(a), 1});
    const PolyhedralCone cone = generated_cone(one_sided, lines, static_cast<Index>(space.rank));
    for (const IntegerVector& facet : cone.halfspaces) {
      Rows left;
      for (const std::size_t a : rows)
        if (dot(facet, normal(a)).is_zero()) left.push_back(a);
      found.insert(std::move(left));
    }
    return found;
  }

  void join(std::size_t tighter, std::size_t looser) {
    if (!joined_.emplace(tighter, looser).second) return;
    const Rows &held = made_.cells[tighter].rows, &kept = made_.cells[looser].rows;
    const auto one_more = std::find_if(held.begin(), held.end(), [&](std::size_t a) {
      return !std::binary_search(kept.begin(), kept.end(), a);
    });
    Wall wall = wall_between(made_.space, independent(made_.space, kept), *one_more);
    wall.tighter = tighter;
    wall.looser = looser;
    made_.cells[tighter].walls.push_back(made_.walls.size());
    made_.cells[looser].walls.push_back(made_.walls.size());
    made_.walls.push_back(std::move(wall));
  }

  Atlas made_;
  std::map<Rows, std::size_t> places_;
  std::set<std::pair<std::size_t, std::size_t>> joined_;
};

}  // namespace

Atlas explored(const ExactProblem& problem, std::size_t most) {
  const ExactSolution answer = exact_active_set(problem, {});
  if (answer.status == Status::infeasible) return {row_space(problem), {}, {}, false, 0};
  Rows tight;
  for (std::size_t a = 0; a < answer.slack.size(); ++a)
    if (sign(answer.slack[a]) == 0) tight.push_back(a);
  return Explorer(row_space(problem)).from(tight, most);
}

}  // namespace convex::atlas
