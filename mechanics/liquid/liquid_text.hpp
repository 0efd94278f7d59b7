#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/lagrangian_text.hpp"

namespace mechanics::liquid {

/// A part of the boundary: where it is, a condition on the coordinates, and what is given there.
struct PartText {
  Text name;
  Text where;
  Text value;  ///< of a free part the pressure, of a wall its acceleration along the outward normal
};

/// All values of a parameter from `low` to `high` at once: what depends on it has a range.
struct ParameterRange {
  std::string name;
  double low = 0, high = 0;
};

/// `[liquid]` as text (docs/liquid.md). What is missing in `velocity` or `force` is 0.
struct LiquidText {
  std::vector<Text> coordinates;
  Text domain, density;
  std::vector<Text> velocity, force;
  std::vector<PartText> free, walls;
  std::vector<NamedText> parameters;
  std::vector<Text> low, high;  ///< the box of a domain by inequalities, or empty
  std::optional<long> cells;    ///< along the longest side
  std::optional<Text> symmetry;
  std::optional<ParameterRange> range;  ///< no file has it
};

}  // namespace mechanics::liquid
