#include "convex/atlas/dropping_rule.hpp"

#include <algorithm>

#include "convex/exact/elimination.hpp"
#include "convex/invariant.hpp"

namespace convex::atlas {

bool rule_is_defined(const Atlas& whole) { return whole.space.count() == whole.space.rank; }

IntegerRows kept_by_rule(const Atlas& whole, std::size_t index) {
  const RowSpace& space = whole.space;
  const Cell& cell = whole.cells[index];
  IntegerRows part;
  for (const std::size_t w : cell.walls) {
    part.push_back(whole.walls[w].form);
    if (whole.walls[w].tighter != index) continue;
    for (Integer& entry : part.back()) entry = -entry;
  }
  // G lambda = s - U A⁻¹z: the rows' forms with their signs turned.
  const auto inverse = positive_definite_inverse(space.gram);
  invariant(inverse.has_value(), "independent rows have a definite Gram matrix");
  for (std::size_t a = 0; a < space.count(); ++a) {
    if (space.two_sided[a]) continue;
    const bool kept = std::binary_search(cell.rows.begin(), cell.rows.end(), a);
    IntegerVector multiplier(space.rank + 1, 0);
    for (std::size_t b = 0; b < space.count(); ++b) {
      const Integer weight = inverse->adjugate[a][b] * space.row_scale[b];
      for (std::size_t i = 0; i < multiplier.size(); ++i)
        kept ? multiplier[i] -= weight * space.rows[b][i] : multiplier[i] += weight * space.rows[b][i];
    }
    make_primitive(multiplier);
    part.push_back(std::move(multiplier));
  }
  return part;
}

RuleVerdict judge_rule(const Atlas& whole, const CellProbability& probability,
                       const std::vector<Probability>& of_cells, double tolerance) {
  RuleVerdict verdict;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    if (whole.cells[c].rows.size() == whole.space.count()) {
      add(verdict.accepted, 1, of_cells[c]);
      continue;
    }
    const Probability right = probability.of(kept_by_rule(whole, c), tolerance);
    add(verdict.right, 1, right);
    add(verdict.wrong, 1, of_cells[c]);
    add(verdict.wrong, -1, right);
  }
  verdict.wrong = not_negative(verdict.wrong);
  return verdict;
}

}  // namespace convex::atlas
