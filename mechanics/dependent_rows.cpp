#include "mechanics/dependent_rows.hpp"

#include "mechanics/row_space.hpp"

namespace mechanics {

std::vector<DependentRow> dependent_rows(const convex::NearestPointProblem& problem, RowsCompared compared) {
  std::vector<Index> rows = problem.two_sided;
  if (!problem.radii || rows.empty()) return {};
  if (compared == RowsCompared::all)
    for (Index a = 0; a < problem.rows(); ++a)
      if (!problem.is_two_sided(a)) rows.push_back(a);
  if (rows.size() < 2 || rows.size() > most_rows_compared) return {};
  const Vector unit = problem.A.diagonal().cwiseSqrt().cwiseInverse();
  RowSpace space(problem.dimension());
  std::vector<Index> kept;
  std::vector<DependentRow> found;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Index row = rows[k];
    const Vector u = problem.U.row(row).cwiseProduct(unit);
    const double radius = problem.radii->row[row];
    const RowSpace::Expansion of_row = space.expansion(u, radius);
    if (of_row.is_independent()) {
      if (k >= problem.two_sided.size()) continue;
      space.keep(u, radius, of_row);
      kept.push_back(row);
      continue;
    }
    found.push_back({row, {}});
    for (std::size_t j = 0; j < kept.size(); ++j)
      if (const double weight = of_row.coefficients[static_cast<Index>(j)]; weight != 0)
        found.back().others.emplace_back(kept[j], weight);
  }
  return found;
}

}  // namespace mechanics
