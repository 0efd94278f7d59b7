#pragma once

#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// The degrees of the nodes up to `root` as polynomials in the velocities, read off their structure: + and -
/// take the larger, * adds, / needs a divisor of degree 0, ^ a constant integer exponent >= 0 unless the base
/// has degree 0, every other operation an argument of degree 0.
struct Degrees {
  std::vector<int> of;         ///< by node; meaningful below the root
  NodeId offending = no_node;  ///< the first node that is no polynomial of degree at most 2
};
Degrees velocity_degrees(const Tape& tape, NodeId root);

}  // namespace mechanics::expression
