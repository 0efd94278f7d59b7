#include "mechanics/liquid/hidden_flux.hpp"

#include <map>

#include "mechanics/liquid/hidden_values.hpp"

namespace mechanics::liquid {
namespace {

using convex::Index;

/// How often a cell is halved, by dimension; regions looked at in all.
constexpr std::array<int, 3> halvings_of_a_wall{6, 6, 3};
constexpr long regions_of_walls = 1'000'000;
constexpr double part_of_flux = 0.01;

class FluxSearch {
 public:
  FluxSearch(const LiquidScene& scene, const CutCells& cells, double scale)
      : scene_(scene), domain_(scene.domain), cells_(cells), d_(scene.dimension()) {
    double largest = scale / domain_.longest();
    for (const WallPiece& wall : cells.walls) {
      if (!(wall.area > 0)) continue;
      const double flux = wall.load / wall.area;
      taken_[{wall.part, wall.point}].take(flux);
      largest = std::max(largest, std::abs(flux));
    }
    least_ = part_of_flux * largest;
  }

  double largest() {
    double most = 0;
    for (const WallPiece& wall : cells_.walls) {
      if (!(wall.area > 0)) continue;
      expected_ = around(wall);
      part_ = &scene_.parts[wall.part];
      normal_ = domain_.outward(domain_.foot(wall.at));
      const Region at = cell_of(wall.point);
      if (!(beyond(at) > least_)) continue;
      for_corners(at, d_, [&](const Point& corner) {
        expected_.take(scene_.wall_flux(*part_, domain_.foot(corner), normal_));
      });
      double sum = 0;
      search(
          at, {d_, halvings_of_a_wall[d_ - 1], &regions_},
          [&](const Region& here) {
            const double beyond_here = beyond(here);
            return beyond_here > least_ && meets_wall(here) ? beyond_here : 0;
          },
          [&](const Region& here, double most_here, int depth) {
            if (depth > 0) return false;
            double size = 0;
            for (std::size_t i = 0; i < d_; ++i) size = std::max(size, here[i].high - here[i].low);
            if (size > 0) sum += most_here * size * (1 + std::log(domain_.longest() / size));
            return false;
          });
      most = std::max(most, sum);
    }
    return most;
  }

 private:
  Hull around(const WallPiece& wall) const {
    Hull hull;
    const auto take = [&](Index k) {
      const auto known = taken_.find({wall.part, k});
      if (known == taken_.end()) return;
      hull.take(known->second.low);
      hull.take(known->second.high);
    };
    for (Index code = 0, all = d_ == 1 ? 3 : d_ == 2 ? 9 : 27; code < all; ++code) {
      Index k = wall.point, rest = code;
      for (std::size_t i = 0; i < d_; ++i, rest /= 3) k += (rest % 3 - 1) * cells_.grid.stride(i);
      take(k);
    }
    return hull;
  }

  Region cell_of(Index k) const {
    const Point node = cells_.at(k);
    Region made{};
    for (std::size_t i = 0; i < d_; ++i)
      made[i] = {std::max(node[i] - 0.5 * cells_.step[i], domain_.low[i]),
                 std::min(node[i] + 0.5 * cells_.step[i], domain_.high[i])};
    return made;
  }

  double beyond(const Region& at) const {
    return expected_.left_by(scene_.wall_flux_range(*part_, at, normal_));
  }

  bool meets_wall(const Region& at) const {
    const Point middle = middle_of(at);
    const Point foot = domain_.foot(middle);
    double away = 0;
    for (std::size_t i = 0; i < d_; ++i) away += (foot[i] - middle[i]) * (foot[i] - middle[i]);
    return away <= 0.26 * diagonal_squared(at, d_) && scene_.part_at(foot) == part_;
  }

  const LiquidScene& scene_;
  const Domain& domain_;
  const CutCells& cells_;
  std::size_t d_;
  double least_ = 0;
  long regions_ = regions_of_walls;
  std::map<std::pair<std::size_t, Index>, Hull> taken_;
  Hull expected_;
  const BoundaryPart* part_ = nullptr;
  Point normal_{};
};

}  // namespace

double hidden_flux(const LiquidScene& scene, const CutCells& cells, double scale) {
  const bool may_vary =
      std::any_of(scene.parts.begin(), scene.parts.end(),
                  [](const BoundaryPart& part) { return !part.is_free && !part.value.is_constant(); }) ||
      std::any_of(scene.force.begin(), scene.force.end(), [](const Field& F) { return !F.is_constant(); });
  return may_vary && !cells.walls.empty() ? FluxSearch(scene, cells, scale).largest() : 0;
}

}  // namespace mechanics::liquid
