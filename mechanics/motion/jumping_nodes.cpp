#include "mechanics/motion/jumping_nodes.hpp"

namespace mechanics::inline motions {

using expression::NodeId;

namespace {

/// Whether it may jump, or have a kink, of which its series before do not tell: at a pole, where an atan2
/// does, or a root of what comes to 0.
bool may_jump(const expression::Tape& tape, NodeId node) {
  using enum expression::Operation;
  switch (tape.operation(node)) {
    case divide:
    case power:
      return !tape.is_constant(tape.operation(node) == divide ? tape.b(node) : tape.a(node));
    case tan:
    case asin:
    case acos:
    case atan2:
    case sqrt:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::vector<bool> nodes_that_may_jump(const expression::Tape& tape) {
  std::vector<bool> may(tape.size());
  for (NodeId node = 0; node < tape.size(); ++node) {
    const int count = expression::arity(tape.operation(node));
    may[node] = may_jump(tape, node) || (count > 0 && may[tape.a(node)]) || (count > 1 && may[tape.b(node)]);
  }
  return may;
}

}  // namespace mechanics::inline motions
