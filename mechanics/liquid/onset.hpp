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

/// None when it passes 0 nowhere: values are tried at distances from the file's that grow from a millionth to
/// a million times its size. A value at which the scene is none (a density of 0, say) ends the search on its
/// side.
std::optional<LiquidOnset> find_onset(const LiquidText&, const std::string& parameter, const LiquidAccuracy&);

}  // namespace mechanics::liquid
