#include "mechanics/liquid/hidden_pressure.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "convex/infinity.hpp"

namespace mechanics::liquid {
namespace {

using convex::Index;
using Place = std::array<Index, 3>;

/// How often a cell is halved, by dimension; regions looked at in all.
constexpr std::array<int, 3> halvings_of_a_cell{6, 6, 3};
constexpr long regions_in_all = 2'000'000;
/// Of the scale, what counts as a bump.
constexpr double part_of_scale = 0.01;

Point middle_of(const Region& at) {
  Point x{};
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.5 * (at[i].low + at[i].high);
  return x;
}

/// Calls work with the halves, along all d axes.
template <class Work>
void for_pieces(const Region& at, std::size_t d, Work work) {
  const Point middle = middle_of(at);
  for (unsigned code = 0; code < 1U << d; ++code) {
    Region piece = at;
    for (std::size_t i = 0; i < d; ++i) ((code >> i & 1U) != 0 ? piece[i].low : piece[i].high) = middle[i];
    work(piece);
  }
}

/// Between nodes first and last of a grid.
Region region_between(const CutCells& cells, const Place& first, const Place& last) {
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
      Place cell{};
      for (std::size_t i = 0; i < d_; ++i)
        cell[i] = std::clamp<Index>(
            static_cast<Index>(std::floor((given.at[i] - cells.low[i]) / cells.step[i])) - cells.first[i], 0,
            cells.grid.points[i] - 2);
      const auto [known, is_new] = given_.try_emplace(cell, Hull{given.pressure, given.pressure});
      if (is_new) continue;
      known->second.low = std::min(known->second.low, given.pressure);
      known->second.high = std::max(known->second.high, given.pressure);
    }
  }

  double largest() {
    std::map<Place, bool> seen;
    for (const auto& [cell, hull] : given_)
      for_cells_around(cell, [&](const Place& there) {
        if (!seen.try_emplace(there, true).second) return;
        Place end{};
        for (std::size_t i = 0; i < d_; ++i) end[i] = there[i] + 1;
        hull_ = {convex::infinity, -convex::infinity};
        for_cells_around(there, [&](const Place& near) {
          const auto known = given_.find(near);
          if (known == given_.end()) return;
          hull_.low = std::min(hull_.low, known->second.low);
          hull_.high = std::max(hull_.high, known->second.high);
        });
        const Region at = region_between(cells_, there, end);
        if (!(most_beyond(at) > least_)) return;
        given_around_ = hull_;
        take_in_corners(at);
        search(at, halvings_of_a_cell[d_ - 1]);
      });
    return largest_;
  }

 private:
  struct Hull {
    double low, high;
  };

  template <class Work>
  void for_cells_around(const Place& cell, Work work) const {
    Place low{}, high{};
    for (std::size_t i = 0; i < d_; ++i) {
      low[i] = std::max<Index>(cell[i] - 1, 0);
      high[i] = std::min<Index>(cell[i] + 1, cells_.grid.points[i] - 2);
    }
    for (Index c = low[2]; c <= high[2]; ++c)
      for (Index b = low[1]; b <= high[1]; ++b)
        for (Index a = low[0]; a <= high[0]; ++a) work(Place{a, b, c});
  }

  /// By how much the values of a part in a region leave those given around.
  double beyond(const Hull& hull, const BoundaryPart& part, const Region& at) const {
    if (!part.is_free || part.value.is_constant()) return 0;
    const expression::Range values = part.value.range(at);
    if (values.is_empty()) return 0;
    return std::max({values.high - hull.high, hull.low - values.low, 0.0});
  }

  double most_beyond(const Region& at) const {
    double most = 0;
    for (const BoundaryPart& part : scene_.parts) most = std::max(most, beyond(hull_, part, at));
    return most;
  }

  /// What parts give at the boundary nearest to the corners: they may go on beyond their last crossing.
  void take_in_corners(const Region& at) {
    for (unsigned code = 0; code < 1U << d_; ++code) {
      Point x{};
      for (std::size_t i = 0; i < d_; ++i) x[i] = (code >> i & 1U) != 0 ? at[i].high : at[i].low;
      x = scene_.domain.foot(x);
      for (const BoundaryPart& part : scene_.parts) {
        const double p = part.is_free ? part.value.raw(x) : hull_.low;
        if (!std::isfinite(p)) continue;
        hull_.low = std::min(hull_.low, p);
        hull_.high = std::max(hull_.high, p);
      }
    }
  }

  void search(const Region& at, int halvings) {
    if (!(most_beyond(at) > std::max(least_, largest_)) || !meets_boundary(at) || ++regions_ > regions_in_all)
      return;
    if (halvings > 0) {
      for_pieces(at, d_, [&](const Region& piece) { search(piece, halvings - 1); });
      return;
    }
    const BoundaryPart* part = scene_.part_at(scene_.domain.foot(middle_of(at)));
    if (part != nullptr)
      if (beyond(hull_, *part, at) > least_) largest_ = std::max(largest_, beyond(given_around_, *part, at));
  }

  bool meets_boundary(const Region& at) const {
    if (scene_.domain.condition) {
      const expression::Range level = scene_.domain.condition->range(at);
      return level.is_empty() || (level.low <= 0 && level.high >= 0);
    }
    double square = 0;
    for (std::size_t i = 0; i < d_; ++i) square += (at[i].high - at[i].low) * (at[i].high - at[i].low);
    return std::abs(scene_.domain.level(middle_of(at))) <= 0.5 * std::sqrt(square) + scene_.domain.reach();
  }

  const LiquidScene& scene_;
  const CutCells& cells_;
  std::size_t d_;
  double least_, largest_ = 0;
  long regions_ = 0;
  std::map<Place, Hull> given_;
  Hull given_around_{}, hull_{};  ///< of crossings; of what is expected
};

}  // namespace

double hidden_pressure(const LiquidScene& scene, const CutCells& cells, double scale) {
  const bool may_vary = std::any_of(scene.parts.begin(), scene.parts.end(), [](const BoundaryPart& part) {
    return part.is_free && !part.value.is_constant();
  });
  return may_vary ? BumpSearch(scene, cells, scale).largest() : 0;
}

}  // namespace mechanics::liquid
