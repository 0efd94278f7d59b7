#include "mechanics/expression/cut_nodes.hpp"

namespace mechanics::expression {

CutNodes::CutNodes(Tape& tape) : tape_(tape) {
  const auto before = static_cast<NodeId>(tape.size());
  NodeId first = 0;
  while (first < before && !has_edge(first)) ++first;
  if (first == before) return;
  image_.resize(before);
  for (NodeId node = 0; node < before; ++node) {
    image_[node] = node;
    const int count = node < first ? 0 : arity(tape.operation(node));
    if (count == 0) continue;
    const NodeId a = image_[tape.a(node)], b = count > 1 ? image_[tape.b(node)] : a;
    if (has_edge(node))
      image_[node] = tape.operation(node) == Operation::atan2
                         ? angle(a, b, tape.origin(node))
                         : tape.apply(Operation::abs, image_[tape.a(tape.a(node))],
                                      image_[tape.a(tape.a(node))], tape.origin(node));
    else if (a != tape.a(node) || (count > 1 && b != tape.b(node)))
      image_[node] = tape.apply(tape.operation(node), a, b, tape.origin(node));
    if (image_[node] != node && tape.is_edge(node)) tape.note_edge(image_[node]);
  }
}

bool CutNodes::has_edge(NodeId node) const {
  if (tape_.is_constant(node)) return false;
  if (tape_.operation(node) == Operation::atan2) return true;
  if (tape_.operation(node) != Operation::sqrt) return false;
  const NodeId square = tape_.a(node), x = tape_.a(square), other = tape_.b(square);
  return tape_.operation(square) == Operation::multiply
             ? x == other
             : tape_.operation(square) == Operation::power && tape_.is_constant(other) &&
                   tape_.constant(other) == 2;
}

NodeId CutNodes::angle(NodeId y, NodeId x, Origin origin) {
  const auto apply = [&](Operation operation, NodeId a, NodeId b) {
    return tape_.apply(operation, a, b, origin);
  };
  const NodeId one = tape_.literal("1", 1, origin),
               quarter = apply(Operation::divide, tape_.pi(origin), tape_.literal("2", 2, origin)),
               opposite = apply(Operation::negate, y, y), side = where(x, one, y, origin);
  tape_.note_edge(side);
  const NodeId above = apply(Operation::subtract, quarter, apply(Operation::atan2, x, y)),
               below = apply(Operation::subtract, apply(Operation::atan2, x, opposite), quarter);
  return where(side, where(x, apply(Operation::atan2, y, x), above, origin), below, origin);
}

NodeId CutNodes::where(NodeId sign, NodeId not_negative, NodeId negative, Origin origin) {
  return tape_.apply(Operation::add, tape_.apply(Operation::where_not_negative, sign, not_negative, origin),
                     tape_.apply(Operation::where_negative, sign, negative, origin), origin);
}

}  // namespace mechanics::expression
