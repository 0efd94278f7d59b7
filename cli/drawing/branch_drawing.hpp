#pragma once

#include <string>
#include <vector>

#include "cli/drawing/gnuplot.hpp"
#include "mechanics/motion/orbit.hpp"

namespace cli::inline drawings {

/// An orbit of a branch, in the order in which the branch is followed.
struct BranchPoint {
  double value = 0;  ///< of the parameter
  mechanics::Orbit orbit;
  std::string event;  ///< what happens here; usually empty
};

/// A branch of periodic orbits over its parameter: positions and velocities at the start, and the size of the
/// largest multiplier. Stable orbits are full lines, unstable ones dotted; events are marked. Where an impact
/// passes the instant of the start, velocities jump and their curves are interrupted, as those of the
/// multiplier are where impacts come or go. Its axis is logarithmic unless all multipliers are 0.
Drawing branch_drawing(const std::vector<BranchPoint>&, const std::vector<std::string>& coordinates,
                       const std::string& parameter, const std::string& title);

}  // namespace cli::inline drawings
