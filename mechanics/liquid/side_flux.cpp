#include "mechanics/liquid/side_flux.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace mechanics::liquid {
namespace {

/// A piece on which something begins is cut into so many along an axis, by the dimension of the side: a place
/// at which the flux jumps is known to half of one.
constexpr std::array<int, 3> parts_of_side{1, 256, 16};

class SideFlux {
 public:
  SideFlux(const LiquidScene& scene, const BoundaryPart& wall, const SidePiece& piece)
      : scene_(scene), wall_(wall), piece_(piece), parts_(parts_of_side[scene.dimension() - 1]) {
    for (std::size_t i = 0; i < scene.dimension(); ++i)
      if (piece.extent[i] > 0) along_[sides_++] = i;
  }

  /// Whether the middles of the parts at its corners are of one wall and branch.
  bool is_one() const {
    const auto here = kind(piece_.middle);
    const int last = parts_ - 1;
    for (unsigned corner = 0; corner < 1U << sides_; ++corner)
      if (kind(middle((corner & 1U) != 0 ? last : 0, (corner & 2U) != 0 ? last : 0)) != here) return false;
    return true;
  }

  double mean() const {
    double sum = 0;
    const int across = sides_ > 1 ? parts_ : 1;
    for (int a = 0; a < parts_; ++a)
      for (int b = 0; b < across; ++b) {
        const Point x = middle(a, b);
        sum += scene_.wall_flux(wall_at(x), x, piece_.normal);
      }
    return sum / (parts_ * across);
  }

  bool has_branches() const {
    const auto has = [](const Field& field) { return field.has_branches(); };
    return has(wall_.value) || std::any_of(scene_.force.begin(), scene_.force.end(), has);
  }

 private:
  const BoundaryPart& wall_at(const Point& x) const {
    const BoundaryPart* found = scene_.part_at(x);
    return found == nullptr || found->is_free ? wall_ : *found;
  }

  std::pair<const BoundaryPart*, std::uint64_t> kind(const Point& x) const {
    const BoundaryPart& wall = wall_at(x);
    std::uint64_t branches = wall.value.has_branches() ? wall.value.branches(x) : 0;
    for (std::size_t i = 0; i < scene_.force.size(); ++i)
      if (piece_.normal[i] != 0 && scene_.force[i].has_branches()) branches += scene_.force[i].branches(x);
    return {&wall, branches};
  }

  Point middle(int a, int b) const {
    Point x = piece_.middle;
    const std::array<int, 2> place{a, b};
    for (std::size_t s = 0; s < sides_; ++s)
      x[along_[s]] += piece_.extent[along_[s]] * ((place[s] + 0.5) / parts_ - 0.5);
    return x;
  }

  const LiquidScene& scene_;
  const BoundaryPart& wall_;
  const SidePiece& piece_;
  int parts_;
  std::size_t sides_ = 0;
  std::array<std::size_t, 2> along_{};
};

}  // namespace

double side_flux(const LiquidScene& scene, const BoundaryPart& wall, const SidePiece& piece,
                 const Point& node) {
  const SideFlux flux(scene, wall, piece);
  if (scene.bound != Bound::none && flux.has_branches()) {
    Region at;
    for (std::size_t i = 0; i < at.size(); ++i)
      at[i] = {std::min(node[i], piece.middle[i] - 0.5 * piece.extent[i]),
               std::max(node[i], piece.middle[i] + 0.5 * piece.extent[i])};
    return end_of(scene.wall_flux_range(wall, at, piece.normal), scene.bound);
  }
  return flux.is_one() ? scene.wall_flux(wall, node, piece.normal) : flux.mean();
}

}  // namespace mechanics::liquid
