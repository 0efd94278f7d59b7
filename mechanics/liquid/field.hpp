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

/// Which end of what a field may be, as long as a parameter has a range (ParameterRange).
enum class Bound : std::uint8_t { none, lower, upper };

/// All that a number may be.
expression::Range range_of(expression::Rounded);
/// The end of a range; NaN where it is empty.
double end_of(expression::Range, Bound);

/// An expression in the coordinates, ready to be evaluated.
class Field {
 public:
  Field() = default;
  Field(const expression::Tape&, expression::NodeId, std::vector<std::string> coordinates, std::string what,
        convex::Place);

  /// Where a derivative jumps it takes one of the two. Throws InvalidInput with the point when the value is
  /// not finite.
  double operator()(const Point&) const;
  /// The same, NaN or infinite where it is not finite.
  double raw(const Point&) const;
  bool is_constant() const { return is_constant_; }
  /// Of its text.
  convex::Place place() const { return place_; }
  /// The same field, whose values are these ends from now on.
  Field bounded(Bound) const;
  bool is_bound() const { return bound_ != Bound::none; }
  /// The end of all values in a region.
  double bound_in(const Region& at) const { return end_of(range(at), bound_); }
  /// Of a constant one, the value with what rounding may have done to it.
  expression::Rounded constant() const { return constant_; }

  /// Taylor coefficients in t at the distance r + t on a ray; of a ball of distances, such as hold at each.
  /// Not finite where they are not known.
  expression::TimeSeries along(const Ray&, expression::Rounded r, int order) const;
  /// At most how far it is on a piece of a ray from a polynomial of degree 11 in the distance: by a Taylor
  /// series about the middle, or by its range. Infinite where neither is known.
  double departure(const Ray&, double from, double to) const;
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
  /// The value where an absolute value in it is 0 and its derivative none: the one of its side above 0.
  double beside_kinks(const Point&) const;

  std::shared_ptr<const CoordinateForm> form_;
  expression::Program program_;
  std::vector<std::string> coordinates_;
  std::string what_;
  convex::Place place_;
  bool is_constant_ = true, may_jump_ = false, has_branches_ = false;
  Bound bound_ = Bound::none;
  expression::Rounded constant_;
  expression::Range constant_range_{0, 0};
  std::vector<expression::Range> ranges_;       // of the program's constants
  std::vector<expression::Rounded> constants_;  // of the program, as they are written
};

}  // namespace mechanics::liquid
