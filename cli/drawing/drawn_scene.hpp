#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/problem_file/problem.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace cli::inline drawings {

/// What `[draw]` shows of a mechanism, as numbers of a state. Its expressions are read as the constraints of
/// a system with the same coordinates, so that their derivatives are at hand too.
class DrawnScene {
 public:
  struct Shape {
    DrawnShape::Kind kind;
    std::string name;
    std::vector<convex::Index> numbers;  ///< where in `values`
    std::vector<convex::Place> places;   ///< of the expressions in the file
  };

  /// Throws InvalidInput with the place in `[draw]` for an expression that is wrong. Without `[draw]` there
  /// are no shapes, and the values are the coordinates.
  explicit DrawnScene(const Problem&);

  const std::vector<Shape>& shapes() const { return shapes_; }
  /// Throws InvalidInput where a value is not finite, or a radius is negative.
  convex::Vector values(const mechanics::State&) const;
  /// The derivatives by the coordinates of some values: one row each.
  convex::SparseRows derivatives(const mechanics::State&, const std::vector<convex::Index>& values) const;

 private:
  std::unique_ptr<const mechanics::LagrangianSystem> system_;
  std::vector<Shape> shapes_;
};

}  // namespace cli::inline drawings
