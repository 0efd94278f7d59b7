#pragma once

#include <optional>
#include <string>

#include "mechanics/liquid/liquid_solution.hpp"

namespace mechanics::liquid {

/// The value of a parameter, nearest to the file's, at which cavitation, inside or at a wall, begins: where
/// the least value of the pressure without the obstacle passes 0.
struct LiquidOnset {
  double value = 0, error = 0;
};

struct OnsetSearch {
  std::optional<LiquidOnset> onset;
  /// None: intervals show that no nearer value was passed, or, without an onset, that there is none in the
  /// range. Else from this value on that is known of the values tried alone: p comes close to 0, or touches
  /// it without a change of sign, or nothing bounds it.
  std::optional<double> unshown;
  /// It is the file's value, and values alone were tried.
  bool is_sampled = false;
};

/// From a millionth to a million times the size of the file's value away from it. Between values tried the
/// data have bounds, and so has the pressure, which grows with them; intervals are halved until they show
/// that it passes 0 nowhere, or hold the value (for what depends on a grid, of the equations of one). A value
/// at which the scene is none (a density of 0, say) ends the search on its side.
OnsetSearch find_onset(const LiquidText&, const std::string& parameter, const LiquidAccuracy&);

}  // namespace mechanics::liquid
