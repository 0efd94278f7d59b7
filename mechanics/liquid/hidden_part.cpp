#include "mechanics/liquid/hidden_part.hpp"

#include <map>

#include "mechanics/liquid/hidden_values.hpp"

namespace mechanics::liquid {
namespace {

using convex::Index;

/// How often a cell is halved, by dimension; regions looked at in all.
constexpr std::array<int, 3> halvings_for_parts{20, 20, 8};
constexpr long regions_for_parts = 200'000;

class PartSearch {
 public:
  PartSearch(const LiquidScene& scene, const CutCells& cells)
      : scene_(scene), cells_(cells), d_(scene.dimension()) {
    for (const GivenPressure& given : cells.pressures) see(given.from, given.part);
    for (const WallPiece& wall : cells.walls) see(wall.point, wall.part);
  }

  std::optional<HiddenPart> find() {
    Places last{};
    for (std::size_t i = 0; i < d_; ++i) last[i] = cells_.grid.points[i] - 1;
    halve_places({}, last, [&](const Places& first, const Places& end) {
      if (found_) return true;
      const Region at = region_around(first, end);
      if (!meets_boundary(at)) return true;
      if (first != end) return is_of_one_part(at);
      const Index k = cells_.grid.at(first[0], first[1], first[2]);
      if (const auto near = seen_.find(k); near != seen_.end())
        for_boundary(scene_.domain, at, [&](const Region& side) { search_in(side, near->second); });
      return true;
    });
    return found_;
  }

 private:
  using Seen = std::vector<bool>;  // by part

  void see(Index k, std::size_t part) {
    for (Index code = 0, all = d_ == 1 ? 3 : d_ == 2 ? 9 : 27; code < all; ++code) {
      Index there = k, rest = code;
      for (std::size_t i = 0; i < d_; ++i, rest /= 3) there += (rest % 3 - 1) * cells_.grid.stride(i);
      Seen& seen = seen_[there];
      seen.resize(scene_.parts.size());
      seen[part] = true;
    }
  }

  Region region_around(const Places& first, const Places& end) const {
    const Point low = cells_.at(cells_.grid.at(first[0], first[1], first[2])),
                high = cells_.at(cells_.grid.at(end[0], end[1], end[2]));
    Region made{};
    for (std::size_t i = 0; i < d_; ++i)
      made[i] = {std::max(low[i] - 0.5 * cells_.step[i], scene_.domain.low[i]),
                 std::min(high[i] + 0.5 * cells_.step[i], scene_.domain.high[i])};
    return made;
  }

  bool meets_boundary(const Region& at) const {
    const Domain& domain = scene_.domain;
    if (domain.condition) {
      const expression::Range level = domain.condition->range(at);
      return level.is_empty() || (level.low <= 0 && level.high >= 0);
    }
    return std::abs(domain.level(middle_of(at))) <=
           0.5 * std::sqrt(diagonal_squared(at, d_)) + domain.reach();
  }

  /// Whether the boundary in a region lies in one part, as far as ranges tell.
  bool is_of_one_part(const Region& at) const {
    int possible = 0;
    for (const BoundaryPart& part : scene_.parts) {
      const expression::Range level = part.where.range(at);
      if (!level.is_empty() && level.low > 0) continue;
      if (++possible > 1) return false;
      if (!level.is_empty() && level.high < 0) return true;
    }
    return d_ == 3;
  }

  void search_in(const Region& cell, const Seen& seen) {
    if (found_) return;
    search(
        cell, {d_, halvings_for_parts[d_ - 1], &regions_},
        [&](const Region& at) { return meets_boundary(at) && may_hold_another(at, seen) ? 1.0 : 0.0; },
        [&](const Region& at, double, int) {
          const Point x = scene_.domain.foot(middle_of(at));
          const BoundaryPart* part = scene_.part_at(x);
          if (part == nullptr ? is_claimed_nowhere(at)
                              : !seen[static_cast<std::size_t>(part - scene_.parts.data())])
            found_ = HiddenPart{part, x};
          return found_.has_value();
        });
  }

  /// Not at points alone: where two parts meet none may claim the point between them.
  bool is_claimed_nowhere(const Region& at) const {
    bool claimed = d_ == 3;
    for_corners(at, d_, [&](const Point& corner) {
      Point x = middle_of(at);
      for (std::size_t i = 0; i < d_; ++i) x[i] += 0.25 * (corner[i] - x[i]);
      claimed = claimed || scene_.part_at(scene_.domain.foot(x)) != nullptr;
    });
    return !claimed;
  }

  bool may_hold_another(const Region& at, const Seen& seen) const {
    std::vector<Point> boundary;
    for_corners(at, d_, [&](const Point& x) { boundary.push_back(scene_.domain.foot(x)); });
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const std::optional<bool> holds =
          scene_.parts[k].where.holds_all_over(at, boundary, scene_.domain.reach());
      if (holds.value_or(true) && !seen[k]) return true;
      if (holds.value_or(false)) return false;
    }
    return d_ < 3;
  }

  const LiquidScene& scene_;
  const CutCells& cells_;
  std::size_t d_;
  long regions_ = regions_for_parts;
  std::map<Index, Seen> seen_;  // by node, around it
  std::optional<HiddenPart> found_;
};

}  // namespace

std::optional<HiddenPart> hidden_part(const LiquidScene& scene, const CutCells& cells) {
  return scene.parts.front().where.is_always() ? std::nullopt : PartSearch(scene, cells).find();
}

}  // namespace mechanics::liquid
