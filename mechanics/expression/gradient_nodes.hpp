#pragma once

#include <utility>
#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// The partial derivatives of a node as nodes of the same tape, by variable, structural zeros left out.
struct GradientNodes {
  std::vector<std::pair<std::uint32_t, NodeId>> by_coordinate, by_velocity;  ///< in increasing order
  NodeId by_time = no_node;                                                  ///< no_node: 0
};

/// One reverse sweep in symbols (Griewank and Walther 2008, section 3.2): about four new nodes for each node
/// below `root`, however many variables there are. Zeros and ones are left out, nothing else is simplified.
GradientNodes gradient_nodes(Tape& tape, NodeId root);

}  // namespace mechanics::expression
