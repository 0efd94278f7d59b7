#include "convex/obstacle_problem/cut_multigrid.hpp"
#include "convex/obstacle_problem/cut_rows.hpp"

namespace convex::inline obstacle_problem {
namespace {

/// The point of a fine grid at the place of a coarse one's.
Index fine_place(const CutGrid& coarse, Index k, const CutGrid& fine) {
  Index there = 0;
  for (std::size_t axis = coarse.dimension; axis-- > 0;) {
    const Index i = k / coarse.stride(axis) - coarse.frame(axis);
    k %= coarse.stride(axis);
    there += (2 * i + fine.frame(axis)) * fine.stride(axis);
  }
  return there;
}

/// Pendants of a coarse grid are taut when one of a fine neighbour is.
std::vector<std::uint8_t> coarser_taut(const CutGrid& fine, const std::vector<std::uint8_t>& taut,
                                       const CutGrid& coarse) {
  std::vector<std::uint8_t> made(coarse.pendants.size(), 0);
  if (made.empty() || taut.empty()) return made;
  std::vector<std::uint8_t> near(at(fine.size()), 0);
  for (std::size_t a = 0; a < fine.pendants.size(); ++a) {
    if (taut[a] == 0) continue;
    for (Index code = 0; code < 27; ++code) {
      Index k = fine.pendants[a].point, rest = code;
      for (std::size_t axis = 0; axis < fine.dimension; ++axis, rest /= 3)
        k += (rest % 3 - 1) * fine.stride(axis);
      near[at(k)] = 1;
    }
  }
  for (std::size_t a = 0; a < coarse.pendants.size(); ++a)
    made[a] = near[at(fine_place(coarse, coarse.pendants[a].point, fine))];
  return made;
}

}  // namespace

void CutMultigrid::set_taut(Level& level, const std::vector<std::uint8_t>& taut) const {
  const CutGrid& grid = *level.grid;
  for (const Index k : level.tied) {
    level.pull[at(k)] = static_cast<float>(grid.pull[at(k)] / unit_);
    level.diagonal[at(k)] = level.sum_at(k);
  }
  level.tied.clear();
  for (const Pendant& pendant : grid.pendants)
    level.pull[at(pendant.point)] = static_cast<float>(grid.pull[at(pendant.point)] / unit_);
  for (std::size_t a = 0; a < taut.size(); ++a)
    if (taut[a] != 0)
      level.pull[at(grid.pendants[a].point)] += static_cast<float>(grid.pendants[a].conductance / unit_);
  for (const Pendant& pendant : grid.pendants)
    level.diagonal[at(pendant.point)] = level.sum_at(pendant.point);
}

void CutMultigrid::set_free(const std::vector<std::uint8_t>& held, std::vector<std::uint8_t> taut) {
  for (std::size_t l = top_; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    const CutGrid& grid = *level.grid;
    if (l > top_) taut = coarser_taut(*levels_[l - 1].grid, taut, grid);
    set_taut(level, taut);
    const Level* fine = l > top_ ? &levels_[l - 1] : nullptr;
    for_rows(grid, [&](Index first, Index j, Index k) {
      for (Index i = 0; i < grid.points[0]; ++i) {
        const Index here = first + i;
        const float diagonal = level.diagonal[at(here)];
        bool is_free = diagonal > 0 && grid.is_unknown(here);
        if (is_free && fine == nullptr) is_free = held[at(here)] == 0;
        if (is_free && fine != nullptr) {
          const Index there = fine->grid->at(2 * i, 2 * j, 2 * k);
          is_free = fine->is_free(there) || !fine->grid->is_unknown(there);
        }
        level.inverse[at(here)] = is_free ? 1 / diagonal : 0;
        if (!level.scale.empty()) level.weight[at(here)] = is_free ? level.scale[at(here)] : 0;
      }
    });
    level.edges.clear();
    if (fine != nullptr) tie_to_held(*fine, level);
  }
}

void CutMultigrid::tie_to_held(const Level& fine, Level& coarse) {
  const CutGrid &grid = *coarse.grid, &from = *fine.grid;
  const auto is_held = [&](Index k) { return from.is_unknown(k) && !fine.is_free(k); };
  const auto fine_edge = [&](Index k, std::size_t side) {
    return fine.edges.empty() || !fine.is_free(k) ? 1 : fine.edges[at(k)][side];
  };
  Edges whole;
  whole.fill(1);
  coarse.edges.assign(at(grid.size()), whole);
  for_rows(grid, [&](Index first, Index j, Index k) {
    for (Index i = 0; i < grid.points[0]; ++i) {
      const Index here = first + i, there = from.at(2 * i, 2 * j, 2 * k);
      if (!coarse.is_free(here)) continue;
      float tie = 0;
      for (std::size_t side = 0; side < 2 * grid.dimension; ++side) {
        const std::size_t axis = side / 2;
        const bool is_behind = side % 2 == 1;
        const Index beside = here + (is_behind ? grid.stride(axis) : -grid.stride(axis)),
                    between = there + (is_behind ? from.stride(axis) : -from.stride(axis));
        const float link = coarse.link[axis][at(is_behind ? here : beside)];
        if (!(link > 0)) continue;
        float& edge = coarse.edges[at(here)][side];
        if (is_held(between))
          edge = fine_edge(there, side) / 2;
        else if (!coarse.is_free(beside))
          edge = (1 + fine_edge(between, side)) / 2;
        tie += link * (1 / edge - 1);
      }
      if (!(tie > 0)) continue;
      coarse.tied.push_back(here);
      coarse.pull[at(here)] += tie;
      coarse.diagonal[at(here)] += tie;
      coarse.inverse[at(here)] = 1 / coarse.diagonal[at(here)];
    }
  });
}

}  // namespace convex::inline obstacle_problem
