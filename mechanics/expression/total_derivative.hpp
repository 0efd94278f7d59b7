#pragma once

#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// d/dt of nodes of one tape as new nodes: q_i becomes v_i, t becomes 1. Each node is differentiated once.
class TotalDerivative {
 public:
  explicit TotalDerivative(Tape& tape) : tape_(&tape) {}
  /// `node` must not depend on velocities.
  NodeId of(NodeId node);

 private:
  NodeId rule(NodeId node);
  NodeId power_rule(NodeId node, Origin at);
  NodeId chain(NodeId outer, NodeId inner, Origin at);
  NodeId sum(Operation operation, NodeId x, NodeId y, Origin at);
  NodeId derivative(NodeId node) const;  // no_node where it is 0 whatever the values are
  Tape* tape_;
  std::vector<NodeId> known_;  // by node; `pending` before, no_node for a structural 0
};

}  // namespace mechanics::expression
