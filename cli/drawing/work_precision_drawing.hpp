#pragma once

#include <string>
#include <vector>

#include "cli/drawing/gnuplot.hpp"
#include "cli/measurement/trial.hpp"

namespace cli::inline drawings {

/// What the axes of a work-precision diagram are.
struct DrawnAs {
  bool multipliers = false;  ///< error of the multipliers instead of that of the acceleration
  std::string relative_to;   ///< times as multiples of this method's; "" means seconds
  bool motions = false;      ///< diagrams of integrators, few lines each: two side by side, with larger letters
};

/// A page of work-precision diagrams, one a problem: time against true error, one line a method; what failed
/// stands hollow at the right edge.
Drawing work_precision_drawing(const std::vector<Trial>&, const DrawnAs&);

/// The trials that count as right, fastest first: those with the fewest seconds whose error is at most
/// `good_error`.
std::vector<Trial> ranked(std::vector<Trial> trials);

}  // namespace cli::inline drawings
