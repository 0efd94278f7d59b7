#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mechanics/expression/program.hpp"
#include "mechanics/expression/range.hpp"
#include "mechanics/expression/rounded.hpp"
#include "mechanics/expression/time_series.hpp"
#include "mechanics/liquid/coordinate_form.hpp"

namespace mechanics::liquid {

/// A point of space; in fewer than three dimensions the rest is 0.
using Point = std::array<double, 3>;

/// "(x = 0.5, y = 0)" of the first coordinates, for a message.
std::string point_text(const std::vector<std::string>& names, const Point&);

/// A ray: from a point, known to its rounding, in the direction of the first coordinate.
using Ray = std::array<expression::Rounded, 3>;

/// A box of points.
using Region = std::array<expression::Range, 3>;

/// What of a ray lies at these distances.
Region region(const Ray&, expression::Range r);

/// An expression in the coordinates, ready to be evaluated.
class Field {
 public:
  Field() = default;
  Field(const expression::Tape&, expression::NodeId, std::vector<std::string> coordinates, std::string what,
        convex::Place);

  /// Throws InvalidInput with the point when the value is not finite.
  double operator()(const Point&) const;
  /// The same, NaN or infinite where it is not finite.
  double raw(const Point&) const;
  bool is_constant() const { return is_constant_; }
  /// Of a constant one, the value with what rounding may have done to it.
  expression::Rounded constant() const { return constant_; }

  /// Taylor coefficients in t at the distance r + t on a ray; of a ball of distances, such as hold at each.
  /// Not finite where they are not known.
  expression::TimeSeries along(const Ray&, expression::Rounded r, int order) const;
  /// All values in a region.
  expression::Range range(const Region&) const;

  /// It, or another expression of its file, chooses between branches that need not fit together.
  bool may_jump() const { return may_jump_; }
  /// It chooses between branches itself.
  bool has_branches() const { return has_branches_; }
  /// A number that is the same where the same branches are taken.
  std::uint64_t branches(const Point&) const;
  /// Of one that is not constant, in two or three dimensions.
  const CoordinateForm& form() const { return *form_; }

 private:
  std::shared_ptr<const CoordinateForm> form_;
  expression::Program program_;
  std::vector<std::string> coordinates_;
  std::string what_;
  convex::Place place_;
  bool is_constant_ = true, may_jump_ = false, has_branches_ = false;
  expression::Rounded constant_;
  std::vector<expression::Rounded> constants_;  // of the program, as they are written
};

}  // namespace mechanics::liquid
