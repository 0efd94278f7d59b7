#include "convex/atlas/atlas.hpp"

#include <algorithm>

#include "convex/exact/elimination.hpp"
#include "convex/invariant.hpp"

namespace convex::atlas {
namespace {

/// For each generator of the cone the rows that it has equality in.
std::vector<std::vector<bool>> tight_rows(const RowSpace& space) {
  std::vector<std::vector<bool>> tight;
  for (const IntegerVector& g : space.cone.generators) {
    tight.emplace_back();
    for (const IntegerVector& row : space.rows) tight.back().push_back(dot(row, g).is_zero());
  }
  return tight;
}

bool has_point(const RowSpace& space, const ConeFace& face) {
  return std::any_of(face.generators.begin(), face.generators.end(),
                     [&](Index g) { return space.cone.generators[at(g)].back().sign() > 0; });
}

bool is_within(const ConeFace& part, const ConeFace& whole) {
  return std::includes(whole.generators.begin(), whole.generators.end(), part.generators.begin(),
                       part.generators.end());
}

/// Whether u_a·p = s_a for all rows at one point: the only vertex, in all rows but those that are never
/// tight.
bool has_apex(const Atlas& whole) {
  std::size_t vertices = 0;
  for (const IntegerVector& g : whole.space.cone.generators) vertices += g.back().sign() > 0 ? 1 : 0;
  return vertices == 1;
}

}  // namespace

std::vector<std::size_t> independent(const RowSpace& space, const std::vector<std::size_t>& rows) {
  Echelon span{space.rank, {}, {}};
  std::vector<std::size_t> chosen;
  for (const std::size_t a : rows) {
    const IntegerVector& row = space.rows[a];
    if (extend(span, IntegerVector(row.begin(), row.end() - 1))) chosen.push_back(a);
  }
  return chosen;
}

Wall wall_between(const RowSpace& space, const std::vector<std::size_t>& looser_basis, std::size_t one_more) {
  // The direction A⁻¹ Σ w_a u_a, a in the basis and one more, that moves no row of the basis.
  std::vector<std::size_t> support = looser_basis;
  support.push_back(one_more);
  IntegerRows products;
  for (const std::size_t a : looser_basis) {
    products.emplace_back();
    for (const std::size_t b : support) products.back().push_back(space.gram[a][b]);
  }
  std::vector<const IntegerVector*> pointers;
  for (const IntegerVector& row : products) pointers.push_back(&row);
  IntegerVector w = common_normal(pointers, support.size());
  invariant(!w.empty(), "independent rows have an independent Gram matrix");
  // It leads off the row more, and all of it stands at the last place: w·gram w = w_last (gram w)_last.
  Integer lead = 0;
  for (std::size_t k = 0; k < support.size(); ++k) lead += space.gram[one_more][support[k]] * w[k];
  invariant(!lead.is_zero(), "the wall between two faces leads from one to the other");
  if (lead.sign() < 0) {
    lead = -lead;
    for (Integer& entry : w) entry = -entry;
  }
  Wall wall;
  wall.normal.assign(static_cast<std::size_t>(space.n), 0);
  wall.form.assign(space.rank + 1, 0);
  Integer bound = 0;
  for (std::size_t k = 0; k < support.size(); ++k) {
    bound += w[k] * space.s[support[k]];
    for (std::size_t i = 0; i < wall.normal.size(); ++i)
      wall.normal[i] += w[k] * space.directions[support[k]][i];
    const Integer weight = w[k] * space.row_scale[support[k]];
    for (std::size_t i = 0; i < wall.form.size(); ++i) wall.form[i] += weight * space.rows[support[k]][i];
  }
  make_primitive(wall.form);
  Integer common = 0;
  for (const Integer& entry : wall.normal) common = greatest_common_divisor(common, entry);
  for (Integer& entry : wall.normal) entry = exact_quotient(entry, common);
  const Fraction scale{1, common};
  wall.offset = Fraction{bound, 1} / space.factor * scale;
  wall.squared_length = Fraction{w.back() * lead, 1} / space.factor * scale * scale;
  return wall;
}

Fraction side(const Wall& wall, const ExactVector& z) {
  return lowest_terms({dot(wall.normal, z.numerators), z.denominator}) - wall.offset;
}

Atlas atlas(const ExactProblem& problem) {
  Atlas made{row_space(problem), {}, {}, false, 0};
  find_cone(made.space);
  const RowSpace& space = made.space;
  if (!space.is_feasible()) return made;
  const auto tight = tight_rows(space);
  std::size_t first = 0;  // of the cells one dimension lower
  for (std::vector<ConeFace>& level : faces(space.cone)) {
    const std::size_t begin = made.cells.size();
    for (ConeFace& face : level) {
      if (!has_point(space, face)) continue;
      Cell cell;
      for (std::size_t a = 0; a < space.count(); ++a)
        if (std::all_of(face.generators.begin(), face.generators.end(),
                        [&](Index g) { return tight[at(g)][a]; }))
          cell.rows.push_back(a);
      cell.freedom = space.n - static_cast<Index>(space.rank) + face.dimension - 1;
      cell.face = std::move(face);
      made.cells.push_back(std::move(cell));
    }
    std::sort(made.cells.begin() + static_cast<std::ptrdiff_t>(begin), made.cells.end(),
              [](const Cell& a, const Cell& b) { return a.rows < b.rows; });
    for (std::size_t looser = begin; looser < made.cells.size(); ++looser) {
      const std::vector<std::size_t> basis = independent(space, made.cells[looser].rows);
      for (std::size_t tighter = first; tighter < begin; ++tighter) {
        if (!is_within(made.cells[tighter].face, made.cells[looser].face)) continue;
        const auto& held = made.cells[tighter].rows;
        const auto& kept = made.cells[looser].rows;
        const auto one_more = std::find_if(held.begin(), held.end(), [&](std::size_t a) {
          return !std::binary_search(kept.begin(), kept.end(), a);
        });
        Wall wall = wall_between(space, basis, *one_more);
        wall.tighter = tighter;
        wall.looser = looser;
        made.cells[tighter].walls.push_back(made.walls.size());
        made.cells[looser].walls.push_back(made.walls.size());
        made.walls.push_back(std::move(wall));
      }
    }
    first = begin;
  }
  made.is_conical = has_apex(made);
  made.explored = made.cells.size();
  return made;
}

std::vector<std::size_t> cells_at(const Atlas& whole, const ExactVector& z) {
  std::vector<int> sides;
  for (const Wall& wall : whole.walls) sides.push_back(sign(side(wall, z)));
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    const auto& walls = whole.cells[c].walls;
    if (std::all_of(walls.begin(), walls.end(), [&](std::size_t w) {
          return whole.walls[w].tighter == c ? sides[w] <= 0 : sides[w] >= 0;
        }))
      found.push_back(c);
  }
  return found;
}

}  // namespace convex::atlas
