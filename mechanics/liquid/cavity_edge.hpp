#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "convex/obstacle_problem/cut_obstacle.hpp"
#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// The edge of the cavity inside cells. Near it p = ½ |h| s² + …, s the distance from the edge, so that p has
/// the vertex of a parabola there; s is a level that is 0 on the edge.
class CavityEdge {
 public:
  CavityEdge(const CutCells&, const convex::CutSolution&);

  bool is_empty() const { return is_empty_; }
  /// Below 0 in the cavity; linear between nodes.
  double level(const Point&) const;
  /// At parts of the boundary where p = 0 is given cells are cut by the domain's level.
  double measure(const Domain&) const;
  std::pair<Point, Point> extent() const;

 private:
  template <class Such>
  bool is_near(convex::Index, Such) const;
  int sign_around(convex::Index) const;
  bool is_liquid(const convex::CutSolution&, convex::Index) const;
  std::pair<double, double> edge_beside(const convex::CutSolution&, convex::Index k, convex::Index by,
                                        double curvature, double step) const;
  void continue_straight(std::vector<double>& known) const;
  void find_levels(const convex::CutSolution&);
  const CutCells& cells_;
  std::vector<bool> cavity_;   // by point
  std::vector<double> level_;  // by point; NaN where there is none
  bool is_empty_ = true;
};

}  // namespace mechanics::liquid
