#include "mechanics/expression/zero_set.hpp"

#include <cmath>

namespace mechanics::expression {
namespace {

bool is_zero(const Tape& tape, NodeId node) {
  return tape.operation(node) == Operation::literal && tape.constant(node) == 0;
}

bool is_factor(const Tape& tape, NodeId node) {
  return tape.is_constant(node) && std::isfinite(tape.constant(node)) && tape.constant(node) != 0;
}

/// One step from f towards g; f where there is none.
NodeId within(const Tape& tape, NodeId f, bool& is_power) {
  const NodeId a = tape.a(f), b = tape.b(f);
  switch (tape.operation(f)) {
    case Operation::negate:
      return a;
    case Operation::subtract:
      return is_zero(tape, b) ? a : is_zero(tape, a) ? b : f;
    case Operation::multiply:
      if (a == b) is_power = true;
      return a == b || is_factor(tape, b) ? a : is_factor(tape, a) ? b : f;
    case Operation::divide:
      return is_factor(tape, b) ? a : f;
    case Operation::power:
      if (!tape.is_constant(b) || !(tape.constant(b) >= 1)) return f;
      if (tape.constant(b) > 1) is_power = true;
      return a;
    default:
      return f;
  }
}

}  // namespace

NodeId base_of_power(const Tape& tape, NodeId f) {
  bool is_power = false;
  NodeId g = f;
  while (!tape.is_constant(g)) {
    const NodeId next = within(tape, g, is_power);
    if (next == g) break;
    g = next;
  }
  return is_power && !tape.is_constant(g) ? g : f;
}

}  // namespace mechanics::expression
