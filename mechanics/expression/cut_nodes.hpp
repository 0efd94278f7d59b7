#pragma once

#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// Expressions with sqrt(x^2) as |x|, and with atan2(y, x) written out by the side of its cut, y = 0 where x
/// < 0, so that its jump of 2π there is one of branches: with w = y where x < 0, else 1, it is
///   π/2 - atan2(x, y)  where x < 0 and w >= 0,    -π/2 + atan2(x, -y)  where w < 0,    itself elsewhere,
/// each smooth across its own border.
class CutNodes {
 public:
  /// Appends to the tape, which must outlive this.
  explicit CutNodes(Tape& tape);
  /// The expression that stands for a node of before; of no_node, that.
  NodeId of(NodeId node) const { return node < image_.size() ? image_[node] : node; }

 private:
  NodeId angle(NodeId y, NodeId x, Origin origin);
  bool has_edge(NodeId node) const;
  NodeId where(NodeId sign, NodeId not_negative, NodeId negative, Origin origin);

  Tape& tape_;
  std::vector<NodeId> image_;  // empty where there is neither
};

}  // namespace mechanics::expression
