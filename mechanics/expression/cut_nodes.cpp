#include "mechanics/expression/cut_nodes.hpp"

namespace mechanics::expression {

CutNodes::CutNodes(Tape& tape) : tape_(tape) {
  const auto before = static_cast<NodeId>(tape.size());
  const auto has_edge = [&](NodeId node) {
    return !tape.is_constant(node) &&
           (tape.operation(node) == Operation::atan2 || under_root(node) != no_node);
  };
  NodeId first = 0;
  while (first < before && !has_edge(first)) ++first;
  if (first == before) return;
  image_.resize(before);
  for (NodeId node = 0; node < before; ++node) {
    image_[node] = node;
    const int count = node < first ? 0 : arity(tape.operation(node));
    if (count == 0) continue;
    const Origin origin = tape.origin(node);
    const NodeId a = image_[tape.a(node)], b = count > 1 ? image_[tape.b(node)] : a;
    if (has_edge(node) && tape.operation(node) == Operation::atan2)
      image_[node] = angle(a, b, origin);
    else if (const auto found = has_edge(node) ? square(under_root(node)) : std::nullopt)
      image_[node] = magnitude({image_[found->of], found->factor}, origin);
    else if (a != tape.a(node) || (count > 1 && b != tape.b(node)))
      image_[node] = tape.apply(tape.operation(node), a, b, origin);
    if (image_[node] != node && tape.is_edge(node)) tape.note_edge(image_[node]);
  }
}

std::optional<CutNodes::Square> CutNodes::square(NodeId node) {
  const Operation operation = tape_.operation(node);
  if (arity(operation) < 2) return std::nullopt;
  const NodeId a = tape_.a(node), b = tape_.b(node);
  if (operation == Operation::power && is(b, 2)) return Square{a};
  if (operation == Operation::multiply && a == b) return Square{a};
  const auto is_positive = [&](NodeId x) { return tape_.is_constant(x) && tape_.constant(x) > 0; };
  const auto times = [&](NodeId of, NodeId factor) -> std::optional<Square> {
    std::optional<Square> found = square(of);
    if (!found) return found;
    found->factor = found->factor == no_node && operation == Operation::multiply
                        ? factor
                        : tape_.apply(operation,
                                      found->factor == no_node ? tape_.literal("1", 1, tape_.origin(node))
                                                               : found->factor,
                                      factor, tape_.origin(node));
    return found;
  };
  if (operation == Operation::multiply && is_positive(a)) return times(b, a);
  if ((operation == Operation::multiply || operation == Operation::divide) && is_positive(b))
    return times(a, b);
  return std::nullopt;
}

NodeId CutNodes::under_root(NodeId node) const {
  const Operation operation = tape_.operation(node);
  return operation == Operation::sqrt || (operation == Operation::power && is(tape_.b(node), 0.5))
             ? tape_.a(node)
             : no_node;
}

NodeId CutNodes::magnitude(const Square& square, Origin origin) {
  const NodeId length = tape_.apply(Operation::abs, square.of, square.of, origin);
  if (square.factor == no_node) return length;
  return tape_.apply(Operation::multiply, tape_.apply(Operation::sqrt, square.factor, square.factor, origin),
                     length, origin);
}

NodeId CutNodes::angle(NodeId y, NodeId x, Origin origin) {
  const auto apply = [&](Operation operation, NodeId a, NodeId b) {
    return tape_.apply(operation, a, b, origin);
  };
  if (tape_.is_constant(y)) {
    if (!is(y, 0)) return apply(Operation::atan2, y, x);
    tape_.note_edge(x);
    return where(x, tape_.literal("0", 0, origin), tape_.pi(origin), origin);
  }
  const NodeId quarter = apply(Operation::divide, tape_.pi(origin), tape_.literal("2", 2, origin));
  if (is(x, 0)) {
    tape_.note_edge(y);
    return apply(Operation::multiply, quarter, apply(Operation::sign, y, y));
  }
  const NodeId one = tape_.literal("1", 1, origin), opposite = apply(Operation::negate, y, y),
               side = where(x, one, y, origin);
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
