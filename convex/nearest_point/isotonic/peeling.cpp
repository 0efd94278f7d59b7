#include "convex/nearest_point/isotonic/peeling.hpp"

namespace convex::inline isotonic {
std::vector<Index> rows_left_by_peeling(const ConstraintRows& U, const std::vector<Index>& rows) {
  const std::size_t n = at(U.dimension());
  // How many rows have the coordinate, and the sum of their positions: of one row, its position.
  std::vector<Index> count(n, 0), sum(n, 0);
  std::vector<bool> left(rows.size(), true);
  for (std::size_t k = 0; k < rows.size(); ++k)
    U.for_each_entry(rows[k], [&](Index entry, double) {
      const auto i = at(entry);
      ++count[i];
      sum[i] += static_cast<Index>(k);
    });
  std::vector<std::size_t> single;
  for (std::size_t i = 0; i < n; ++i)
    if (count[i] == 1) single.push_back(i);
  while (!single.empty()) {
    const std::size_t own = single.back();
    single.pop_back();
    if (count[own] != 1) continue;
    const Index k = sum[own];
    left[at(k)] = false;
    U.for_each_entry(rows[at(k)], [&](Index entry, double) {
      const auto i = at(entry);
      --count[i];
      sum[i] -= k;
      if (count[i] == 1) single.push_back(i);
    });
  }
  std::vector<Index> core;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (left[k]) core.push_back(rows[k]);
  return core;
}

}  // namespace convex::inline isotonic
