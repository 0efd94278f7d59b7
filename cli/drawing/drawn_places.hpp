#pragma once

#include <array>
#include <vector>

#include "cli/drawing/drawn_scene.hpp"

namespace cli::inline drawings {

/// A place of a mechanism at which a force may be drawn.
struct DrawnPlace {
  convex::Index x, y, radius = -1;       ///< where in the values; radius -1 for none
  convex::Index end_x = -1, end_y = -1;  ///< of a segment: the place is where `touching` is nearest to it
  std::size_t touching = 0;
};
using DrawnPlaces = std::vector<DrawnPlace>;

/// The places of a drawing: points, ends of segments, centres of circles, and where another of these touches
/// a segment.
class PlacesOfScene {
 public:
  explicit PlacesOfScene(const DrawnScene&);

  const DrawnPlaces& named() const { return named_; }
  /// The points of segments that a named place touches, or its circle, between their ends.
  DrawnPlaces touched(const convex::Vector& values) const;

  /// Of an instant: a place, and the derivatives of both its numbers by the coordinates as columns.
  struct Spot {
    Eigen::Vector2d p;
    convex::Matrix columns;
  };
  std::vector<Spot> spots(const DrawnPlaces&, const mechanics::State&, const convex::Vector& values) const;
  /// Of all places those that move where the coordinates of u do; J: `derivatives` of them.
  static DrawnPlaces moved_with(const convex::Vector& u, const DrawnPlaces&, const convex::SparseRows& J);
  convex::SparseRows derivatives(const DrawnPlaces&, const mechanics::State&) const;
  /// Whether the place is on something drawn that no coordinate moves.
  bool is_on_ground(const Spot&, const mechanics::State&, const convex::Vector& values) const;
  /// Places no farther apart than this are one.
  double nearness(const convex::Vector& values) const;

 private:
  double along(const DrawnPlace&, const convex::Vector& values) const;

  const DrawnScene& scene_;
  DrawnPlaces named_;
  std::vector<std::array<convex::Index, 4>> segments_;
};

}  // namespace cli::inline drawings
