#include "mechanics/motion/taylor_matrix.hpp"

#include <algorithm>

namespace mechanics::inline motions {
namespace {

using expression::Slot;

std::vector<Slot> kept_series(const TaylorRows::Asked& asked, const TaylorSteps& steps) {
  std::vector<Slot> kept = asked.series;
  for (const Switch& one : steps.switches) kept.push_back(one.argument);
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

/// Instructions of a row, of a term, and of eight numbers of a column.
constexpr std::size_t work_of_row = 14, work_of_term = 6, work_of_eight = 2;

/// Instructions that bring a factor to its place.
constexpr std::size_t work_of_factor = 2;

/// Groups with orders above 0: momenta and rates; forces and rows. Of constraints themselves only the values
/// are looked for.
constexpr std::size_t most_groups = 2;

}  // namespace

std::size_t groups_with_orders(const TaylorSteps& steps) { return std::min(most_groups, steps.ends.size()); }

TaylorMatrix::TaylorMatrix(const TaylorSteps& steps, const TaylorRows& rows, const Equations& equations)
    : coordinates(equations.momentum.size()),
      variables(steps.variables),
      row_count(rows.ends[groups_with_orders(steps) - 1].rows),
      products(rows.ends[groups_with_orders(steps) - 1].products) {
  if (coordinates == 0 || !steps.switches.empty())
    return;  // what is not finite on a branch not taken would spoil the others
  const std::size_t n = coordinates, count = row_count;
  const std::size_t terms = count == 0 ? 0 : rows.rows[count - 1].end;
  std::vector<std::size_t> place(rows.series);  // among the numbers; 0 where it has none
  std::vector<std::pair<Slot, std::size_t>> asked;
  std::size_t size = 2 * n;
  const auto place_of = [&](Slot series) {
    if (series >= n && series < 2 * n) return series - n;  // a velocity
    if (place[series] == 0) {
      place[series] = size++;
      asked.emplace_back(series, place[series]);
    }
    return place[series];
  };
  for (std::size_t i = 0; i < n; ++i) asked.emplace_back(equations.momentum[i], i);
  for (const auto& [i, slot] : equations.force) asked.emplace_back(slot, n + static_cast<std::size_t>(i));
  for (const Slot slot : equations.kept) kept_at.push_back(place_of(slot));
  const std::size_t factors = std::max(blocks_of(products), std::size_t{1});
  place_of_x.resize(factors);
  place_of_y.resize(factors);
  for (std::size_t p = 0; p < products; ++p) {
    place_of_x[p / Eight::count].of[p % Eight::count] = static_cast<long long>(place_of(rows.products[p].x));
    place_of_y[p / Eight::count].of[p % Eight::count] = static_cast<long long>(place_of(rows.products[p].y));
  }
  const std::size_t of_numbers = blocks_of(size);
  if (of_numbers > TaylorOrders::most_blocks || factors > TaylorOrders::most_blocks ||
      (products + 2 * n) * (of_numbers * work_of_eight + work_of_factor) >
          count * work_of_row + terms * work_of_term + 8 * n * n)
    return;
  blocks = of_numbers;
  sweep = TaylorSweep(rows, count, variables, products, asked, blocks);
  weighted.resize(factors);
  for (std::size_t p = 0; p < products; ++p)
    weighted[p / Eight::count].of[p % Eight::count] = rows.products[p].is_weighted ? 1 : 0;
}

TaylorProgram::TaylorProgram(TaylorSteps of, const TaylorRows::Asked& asked,
                             const std::vector<Slot>& momentum,
                             const std::vector<std::pair<Index, Slot>>& force)
    : steps(std::move(of)),
      rows(steps, asked),
      kept(kept_series(asked, steps)),
      matrix(steps, rows, {momentum, force, kept}) {}

}  // namespace mechanics::inline motions
