#include "mechanics/motion/jumping_nodes.hpp"

namespace mechanics::inline motions {

using expression::NodeId;

namespace {

/// A quotient or power that may come to its pole.
bool is_quotient(const expression::Tape& tape, NodeId node) {
  using enum expression::Operation;
  const expression::Operation operation = tape.operation(node);
  return (operation == divide && !tape.is_constant(tape.b(node))) ||
         (operation == power && !tape.is_constant(tape.a(node)));
}

/// What may jump besides, or have a kink: at a pole, where an atan2 does, or at a root of what comes to 0.
bool is_other(const expression::Tape& tape, NodeId node) {
  using enum expression::Operation;
  const expression::Operation operation = tape.operation(node);
  return operation == tan || operation == asin || operation == acos || operation == atan2 ||
         operation == sqrt;
}

/// Whether a node is such, or is made of one.
template <class Is>
std::vector<bool> nodes_with(const expression::Tape& tape, Is is) {
  std::vector<bool> with(tape.size());
  for (NodeId node = 0; node < tape.size(); ++node) {
    const int count = expression::arity(tape.operation(node));
    with[node] = is(tape, node) || (count > 0 && with[tape.a(node)]) || (count > 1 && with[tape.b(node)]);
  }
  return with;
}

}  // namespace

std::vector<bool> nodes_that_may_jump(const expression::Tape& tape) {
  return nodes_with(tape, [](const expression::Tape& of, NodeId node) {
    return is_quotient(of, node) || is_other(of, node);
  });
}

std::vector<bool> nodes_of_quotients(const expression::Tape& tape) {
  std::vector<bool> found = nodes_with(tape, is_quotient);
  const std::vector<bool> others = nodes_with(tape, is_other);
  for (std::size_t node = 0; node < found.size(); ++node) found[node] = found[node] && !others[node];
  return found;
}

}  // namespace mechanics::inline motions
