#include "mechanics/liquid/hidden_pressure.hpp"

#include <map>

#include "mechanics/liquid/hidden_values.hpp"

namespace mechanics::liquid {
namespace {

using convex::Index;

/// How often a cell is halved, by dimension; regions looked at in all.
constexpr std::array<int, 3> halvings_of_a_cell{6, 6, 3};
constexpr long regions_in_all = 2'000'000;
/// Of the scale, what counts as a bump.
constexpr double part_of_scale = 0.01;

/// Between nodes first and last of a grid.
Region region_between(const CutCells& cells, const Places& first, const Places& last) {
  const Point low = cells.at(cells.grid.at(first[0], first[1], first[2])),
              high = cells.at(cells.grid.at(last[0], last[1], last[2]));
  Region made;
  for (std::size_t i = 0; i < low.size(); ++i) made[i] = {low[i], high[i]};
  return made;
}

class BumpSearch {
 public:
  BumpSearch(const LiquidScene& scene, const CutCells& cells, double scale)
      : scene_(scene), cells_(cells), d_(scene.dimension()), least_(part_of_scale * scale) {
    for (const GivenPressure& given : cells.pressures) {
      Places cell{};
      for (std::size_t i = 0; i < d_; ++i)
        cell[i] = std::clamp<Index>(
            static_cast<Index>(std::floor((given.at[i] - cells.low[i]) / cells.step[i])) - cells.first[i], 0,
            cells.grid.points[i] - 2);
      given_[cell].take(given.pressure);
    }
  }

  double largest() {
    std::map<Places, bool> seen;
    for (const auto& [cell, hull] : given_)
      for_cells_around(cell, 1, [&](const Places& there) {
        if (!seen.try_emplace(there, true).second) return;
        Places end{};
        for (std::size_t i = 0; i < d_; ++i) end[i] = there[i] + 1;
        hull_ = given_around(there, 1);
        const Region at = region_between(cells_, there, end);
        if (!(most_beyond(at) > least_)) return;
        const Hull near = hull_, wide = given_around(there, 2);
        // What is given may go on beyond its last crossing as it goes between the others.
        const double width = wide.high - wide.low;
        hull_.low -= width;
        hull_.high += width;
        for_boundary(scene_.domain, at, [&](const Region& side) {
          search(
              side, {d_, halvings_of_a_cell[d_ - 1], &regions_},
              [&](const Region& here) {
                const double most = most_beyond(here);
                return most > std::max(least_, largest_) && meets_boundary(here) ? most : 0;
              },
              [&](const Region& here, double, int depth) {
                if (depth > 0) return false;
                const BoundaryPart* part = scene_.part_at(scene_.domain.foot(middle_of(here)));
                if (part != nullptr && beyond(hull_, *part, here) > least_)
                  largest_ = std::max(largest_, beyond(near, *part, here));
                return false;
              });
        });
      });
    return largest_;
  }

 private:
  template <class Work>
  void for_cells_around(const Places& cell, Index reach, Work work) const {
    Places low{}, high{};
    for (std::size_t i = 0; i < d_; ++i) {
      low[i] = std::max<Index>(cell[i] - reach, 0);
      high[i] = std::min<Index>(cell[i] + reach, cells_.grid.points[i] - 2);
    }
    for (Index c = low[2]; c <= high[2]; ++c)
      for (Index b = low[1]; b <= high[1]; ++b)
        for (Index a = low[0]; a <= high[0]; ++a) work(Places{a, b, c});
  }

  /// Between the values at the crossings in cells so near.
  Hull given_around(const Places& cell, Index reach) const {
    Hull hull;
    for_cells_around(cell, reach, [&](const Places& near) {
      const auto known = given_.find(near);
      if (known == given_.end()) return;
      hull.take(known->second.low);
      hull.take(known->second.high);
    });
    return hull;
  }

  /// By how much the values of a part in a region leave those given around.
  double beyond(const Hull& hull, const BoundaryPart& part, const Region& at) const {
    return part.is_free && !part.value.is_constant() ? hull.left_by(part.value.range(at)) : 0;
  }

  double most_beyond(const Region& at) const {
    double most = 0;
    for (const BoundaryPart& part : scene_.parts) most = std::max(most, beyond(hull_, part, at));
    return most;
  }

  bool meets_boundary(const Region& at) const {
    if (scene_.domain.condition) {
      const expression::Range level = scene_.domain.condition->range(at);
      return level.is_empty() || (level.low <= 0 && level.high >= 0);
    }
    return std::abs(scene_.domain.level(middle_of(at))) <=
           0.5 * std::sqrt(diagonal_squared(at, d_)) + scene_.domain.reach();
  }

  const LiquidScene& scene_;
  const CutCells& cells_;
  std::size_t d_;
  double least_, largest_ = 0;
  long regions_ = regions_in_all;
  std::map<Places, Hull> given_;
  Hull hull_;  ///< of what is expected in a cell
};

}  // namespace

double hidden_pressure(const LiquidScene& scene, const CutCells& cells, double scale) {
  const bool may_vary = std::any_of(scene.parts.begin(), scene.parts.end(), [](const BoundaryPart& part) {
    return part.is_free && !part.value.is_constant();
  });
  return may_vary ? BumpSearch(scene, cells, scale).largest() : 0;
}

}  // namespace mechanics::liquid
