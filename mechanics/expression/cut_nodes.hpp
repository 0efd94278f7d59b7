#pragma once

#include <optional>
#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// Expressions with sqrt(c x^2), c > 0 a number, as sqrt(c) |x|, and with atan2(y, x) written out by the side
/// of its cut, y = 0 where x < 0, so that its jump of 2π there is one of branches: with w = y where x < 0,
/// else 1, it is
///   π/2 - atan2(x, y)  where x < 0 and w >= 0,    -π/2 + atan2(x, -y)  where w < 0,    itself elsewhere,
/// each smooth across its own border. Of y = 0 it is 0 or π, by the sign of x; of x = 0, π/2 sign(y).
class CutNodes {
 public:
  /// Appends to the tape, which must outlive this.
  explicit CutNodes(Tape& tape);
  /// The expression that stands for a node of before; of no_node, that.
  NodeId of(NodeId node) const { return node < image_.size() ? image_[node] : node; }

 private:
  struct Square {
    NodeId of;
    NodeId factor = no_node;  // none: 1
  };
  /// What a node is the square of, as its structure tells.
  std::optional<Square> square(NodeId node);
  /// What a root is the root of; no_node for others.
  NodeId under_root(NodeId node) const;
  NodeId magnitude(const Square& square, Origin origin);
  NodeId angle(NodeId y, NodeId x, Origin origin);
  NodeId where(NodeId sign, NodeId not_negative, NodeId negative, Origin origin);
  bool is(NodeId node, double number) const {
    return tape_.is_constant(node) && tape_.constant(node) == number;
  }

  Tape& tape_;
  std::vector<NodeId> image_;  // empty where there is neither
};

}  // namespace mechanics::expression
