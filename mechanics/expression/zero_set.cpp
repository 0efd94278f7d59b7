#include "mechanics/expression/zero_set.hpp"

#include <cmath>
#include <utility>

namespace mechanics::expression {
namespace {

bool is_zero(const Tape& tape, NodeId node) {
  return tape.operation(node) == Operation::literal && tape.constant(node) == 0;
}

bool is_factor(const Tape& tape, NodeId node) {
  return tape.is_constant(node) && std::isfinite(tape.constant(node)) && tape.constant(node) != 0;
}

/// The one factor that a product has beside numbers, and how often; f itself, once, where there are several.
std::pair<NodeId, int> only_factor(const Tape& tape, NodeId f) {
  const NodeId a = tape.a(f), b = tape.b(f);
  switch (tape.operation(f)) {
    case Operation::negate:
      return only_factor(tape, a);
    case Operation::divide:
      return is_factor(tape, b) ? only_factor(tape, a) : std::pair{f, 1};
    case Operation::multiply: {
      if (is_factor(tape, a)) return only_factor(tape, b);
      if (is_factor(tape, b)) return only_factor(tape, a);
      const auto [left, times] = only_factor(tape, a);
      const auto [right, more] = only_factor(tape, b);
      return left == right ? std::pair{left, times + more} : std::pair{f, 1};
    }
    default:
      return {f, 1};
  }
}

/// One step from f towards g; f where there is none.
NodeId within(const Tape& tape, NodeId f, bool& is_power) {
  const NodeId a = tape.a(f), b = tape.b(f);
  switch (tape.operation(f)) {
    case Operation::negate:
      return a;
    case Operation::subtract:
      return is_zero(tape, b) ? a : is_zero(tape, a) ? b : f;
    case Operation::multiply: {
      const auto [factor, times] = only_factor(tape, f);
      if (times > 1) is_power = true;
      return factor;
    }
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
