#pragma once

#include <optional>
#include <string>

#include "mechanics/liquid/first_change.hpp"
#include "mechanics/liquid/liquid_scene.hpp"

namespace mechanics::liquid {

/// A scene as a parameter varies: the least value of its pressure without the obstacle, below 0 where there
/// is cavitation; without a free part the sum of the loads, which is below 0 if and only if the walls lack
/// liquid.
class ParameterFamily {
 public:
  ParameterFamily(const LiquidText&, std::string parameter);

  /// None where the scene is none (a density of 0, say). `cells`: of the grid, for what is no line. Its
  /// rounding is known of lines; of an h without bound the sum is all that there is.
  std::optional<RoundedValue> least(double value, long cells) const;
  /// Whether intervals can tell of it: not where the domain, or which part is where, depends on the
  /// parameter, but for the ends of intervals and the radii of balls.
  bool has_bounds() const { return has_bounds_; }
  /// Shown for all values from low to high: it stays below 0, or (`negative` false) it does not fall below 0.
  /// From data below, or above, those of all these values; of a grid for its equations.
  bool keeps_sign(double low, double high, bool negative, long cells) const;

 private:
  const LiquidText& text_;
  std::string parameter_;
  bool moves_domain_ = false, has_bounds_ = true;
};

}  // namespace mechanics::liquid
