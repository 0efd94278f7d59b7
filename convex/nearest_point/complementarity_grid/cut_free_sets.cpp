#include "convex/nearest_point/complementarity_grid/cut_multigrid.hpp"
#include "convex/nearest_point/complementarity_grid/cut_rows.hpp"

namespace convex::inline complementarity_grid {

void CutMultigrid::set_free(const std::vector<std::uint8_t>& held, const std::vector<std::uint8_t>& taut) {
  std::vector<std::uint8_t> taut_here = taut;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const CutGrid& grid = *level.grid;
    for (Index k = 0; k < grid.size(); ++k) {
      double sum = grid.pull[at(k)];
      if (grid.is_unknown(k))
        for (std::size_t axis = 0; axis < grid.dimension; ++axis)
          sum += grid.link[axis][at(k)] + grid.link[axis][at(k - grid.stride(axis))];
      level.diagonal[at(k)] = sum;
    }
    if (l > 0) {  // neighbours of the fine pendants that are taut
      const CutGrid& fine = *levels_[l - 1].grid;
      std::vector<std::uint8_t> near(at(fine.size()), 0);
      for (std::size_t a = 0; a < fine.pendants.size(); ++a) {
        if (!taut_here[a]) continue;
        for (Index code = 0; code < 27; ++code) {
          Index k = fine.pendants[a].point, rest = code;
          for (std::size_t axis = 0; axis < fine.dimension; ++axis, rest /= 3)
            k += (rest % 3 - 1) * fine.stride(axis);
          near[at(k)] = 1;
        }
      }
      std::vector<std::uint8_t> taut_coarse(grid.pendants.size(), 0);
      const auto place = [&](Index coarse_point) {
        Index k = coarse_point, fine_point = 0;
        for (std::size_t axis = grid.dimension; axis-- > 0;) {
          const Index i = k / grid.stride(axis) - grid.frame(axis);
          k %= grid.stride(axis);
          fine_point += (2 * i + fine.frame(axis)) * fine.stride(axis);
        }
        return fine_point;
      };
      for (std::size_t a = 0; a < grid.pendants.size(); ++a)
        taut_coarse[a] = near[at(place(grid.pendants[a].point))];
      taut_here.swap(taut_coarse);
      const std::vector<std::uint8_t>& fine_free = levels_[l - 1].free;
      for_rows(grid, [&](Index first, Index j, Index k) {
        for (Index i = 0; i < grid.points[0]; ++i) {
          const Index there = fine.at(2 * i, 2 * j, 2 * k);
          level.free[at(first + i)] =
              grid.is_unknown(first + i) && (fine_free[at(there)] != 0 || !fine.is_unknown(there));
        }
      });
    } else {
      for (Index k = 0; k < grid.size(); ++k) level.free[at(k)] = grid.is_unknown(k) && held[at(k)] == 0;
      load_ = grid.load;
      pull_ = grid.pull;
    }
    for (std::size_t a = 0; a < grid.pendants.size(); ++a) {
      if (!taut_here[a]) continue;
      const Pendant& pendant = grid.pendants[a];
      level.diagonal[at(pendant.point)] += pendant.conductance;
      if (l > 0) continue;
      pull_[at(pendant.point)] += pendant.conductance;
      load_[at(pendant.point)] -= pendant.conductance * pendant.shift;
    }
    for (Index k = 0; k < grid.size(); ++k)
      level.inverse[at(k)] =
          level.free[at(k)] != 0 && level.diagonal[at(k)] > 0 ? 1 / level.diagonal[at(k)] : 0;
  }
}

}  // namespace convex::inline complementarity_grid
