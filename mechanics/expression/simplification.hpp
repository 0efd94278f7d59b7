#pragma once

#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// Copies expressions to another tape with sums with 0, products with 0 and ±1, powers 0 and 1 and double
/// signs taken out, and numbers that are exact folded.
class Simplification {
 public:
  /// `numbers`: what is constant becomes a number as a whole, parameters with it.
  Simplification(const Tape& from, Tape& to, bool numbers) : from_(&from), to_(&to), numbers_(numbers) {}

  NodeId operator()(NodeId root);

 private:
  NodeId copied(NodeId node);
  NodeId rebuilt(Operation operation, NodeId a, NodeId b);
  NodeId number(double value);
  NodeId negative(NodeId x);
  bool is(NodeId node, double value) const;
  bool is_number(NodeId node) const { return to_->operation(node) == Operation::literal; }
  bool is_negative(NodeId node) const { return to_->operation(node) == Operation::negate; }
  NodeId product(NodeId a, NodeId b);
  NodeId sum(NodeId a, NodeId b);
  NodeId difference(NodeId a, NodeId b);
  NodeId quotient(NodeId a, NodeId b);

  const Tape* from_;
  Tape* to_;
  bool numbers_;
  Origin at_;
  std::vector<NodeId> known_;
};

/// The shortest digits that read back to the same double.
std::string shortest_digits(double x);

}  // namespace mechanics::expression
