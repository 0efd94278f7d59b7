#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/report/solve_report.hpp"

namespace cli::inline drawings {

/// Moreau's problem in the plane of two accelerations, the others held at their true values: there too the
/// true point is the nearest one that the contacts allow to the free one, in the metric A of the two.
struct PlaneSection {
  std::array<convex::Index, 2> axes{0, 1};  ///< coordinates
  Eigen::Matrix2d A;
  Eigen::Vector2d free, truth;
  std::optional<Eigen::Vector2d> classical;  ///< with every contact held; of two coordinates alone
  struct Row {
    Eigen::Vector2d u;
    double s = 0;
    convex::Index row = 0;
    bool tight = false, two_sided = false;
  };
  std::vector<Row> rows;
  std::vector<convex::Index> without_line;  ///< rows that no acceleration of the plane changes
};

/// `plane`: "x,y", two names of coordinates; without it the two of the scene, or of more the two that the
/// reactions change most. InvalidInput for other names and for a scene without two coordinates or an answer.
PlaneSection plane_section(const SolvedScene&, const std::optional<std::string>& plane);

}  // namespace cli::inline drawings
