#include "convex/obstacle_problem/cut_edge.hpp"

#include <algorithm>

#include "convex/infinity.hpp"
#include "convex/obstacle_problem/cut_rows.hpp"

namespace convex::inline obstacle_problem {
namespace {

/// The unknowns within so many steps of those beside which the set changes, by colour, each in order.
std::array<std::vector<Index>, 2> points_near_edge(const CutGrid& grid, const std::vector<std::uint8_t>& held,
                                                   int steps) {
  std::vector<std::uint8_t> seen(held.size(), 0);
  std::vector<Index> near;
  const auto visit = [&](Index k) {
    if (seen[at(k)] != 0 || !grid.is_unknown(k)) return;
    seen[at(k)] = 1;
    near.push_back(k);
  };
  for_rows(grid, [&](Index first, Index, Index) {
    for (Index k = first; k < first + grid.points[0]; ++k)
      for (std::size_t axis = 0; axis < grid.dimension; ++axis) {
        const Index other = k + grid.stride(axis);
        if (held[at(k)] == held[at(other)] || !grid.is_unknown(k) || !grid.is_unknown(other)) continue;
        visit(k);
        visit(other);
      }
  });
  std::size_t from = 0;
  for (int step = 0; step < steps; ++step)
    for (const std::size_t end = near.size(); from < end; ++from)
      for (std::size_t axis = 0; axis < grid.dimension; ++axis)
        for (const Index s : {-grid.stride(axis), grid.stride(axis)}) visit(near[from] + s);
  std::sort(near.begin(), near.end());
  std::array<std::vector<Index>, 2> colours;
  for (const Index k : near) {
    Index rest = k, sum = 0;
    for (std::size_t axis = grid.dimension; axis-- > 0;) {
      sum += rest / grid.stride(axis);
      rest %= grid.stride(axis);
    }
    colours[at(sum % 2)].push_back(k);
  }
  return colours;
}

}  // namespace

void relax_all(const CutEquations& equations, int sweeps, std::vector<double>& q) {
  const CutGrid& grid = equations.grid();
  std::array<std::vector<double>, 2> colours;
  for (std::vector<double>& colour : colours) colour.resize(at(grid.points[0]));
  for (std::size_t i = 0; i < colours[0].size(); ++i) colours[i % 2][i] = 1;
  std::vector<double> inverse(q.size()), lowest(at(grid.points[0]));
  for (Index k = 0; k < grid.size(); ++k)
    if (const double diagonal = grid.is_unknown(k) ? equations.diagonal(k) : 0; diagonal > 0)
      inverse[at(k)] = 1 / diagonal;
  for (int colour = 0; colour < 2 * sweeps; ++colour)
    for_rows(grid, [&](Index first, Index j, Index k) {
      for (Index i = 0; i < grid.points[0]; ++i)
        lowest[at(i)] = grid.kind[at(first + i)] == CutPoint::bounded ? 0 : -infinity;
      cut_kernels::relax_above(equations.row(first), equations.load(first), inverse.data() + first,
                               colours[at((j + k + colour) % 2)].data(), lowest.data(), q.data() + first);
    });
}

void relax_edge(const CutEquations& equations, int sweeps, std::vector<std::uint8_t>& held,
                std::vector<double>& q) {
  const CutGrid& grid = equations.grid();
  const auto colours = points_near_edge(grid, held, sweeps / 2);
  const auto is_bounded = [&](Index k) { return grid.kind[at(k)] == CutPoint::bounded; };
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const std::vector<Index>& colour : colours)
      for (const Index k : colour) {
        const double free = equations.minimum(q, k, q[at(k)]);
        q[at(k)] = is_bounded(k) ? std::max(0.0, free) : free;
      }
  for (const std::vector<Index>& colour : colours)
    for (const Index k : colour) held[at(k)] = is_bounded(k) && q[at(k)] == 0;
}

}  // namespace convex::inline obstacle_problem
