#include "mechanics/expression/total_derivative.hpp"

#include <algorithm>

namespace mechanics::expression {
namespace {

constexpr NodeId pending = no_node - 1, marked = no_node - 2;

}  // namespace

NodeId TotalDerivative::of(NodeId node) {
  std::vector<NodeId> todo, open{node};
  known_.resize(tape_->size(), pending);
  while (!open.empty()) {
    const NodeId next = open.back();
    open.pop_back();
    if (tape_->is_constant(next) || known_[next] != pending) continue;
    known_[next] = marked;
    todo.push_back(next);
    if (arity(tape_->operation(next)) >= 1) open.push_back(tape_->a(next));
    if (arity(tape_->operation(next)) == 2) open.push_back(tape_->b(next));
  }
  std::sort(todo.begin(), todo.end());  // operands first
  for (const NodeId next : todo) known_[next] = rule(next);
  const NodeId result = derivative(node);
  return result == no_node ? tape_->literal("0", 0, tape_->origin(node)) : result;
}

NodeId TotalDerivative::derivative(NodeId node) const {
  return tape_->is_constant(node) ? no_node : known_[node];
}

NodeId TotalDerivative::chain(NodeId outer, NodeId inner, Origin at) {
  return inner == no_node ? no_node : tape_->apply(Operation::multiply, outer, inner, at);
}

NodeId TotalDerivative::sum(Operation operation, NodeId x, NodeId y, Origin at) {
  if (y == no_node) return x;
  if (x != no_node) return tape_->apply(operation, x, y, at);
  return operation == Operation::add ? y : tape_->apply(Operation::negate, y, y, at);
}

NodeId TotalDerivative::rule(NodeId node) {
  using enum Operation;
  Tape& tape = *tape_;
  const Operation operation = tape.operation(node);
  const Origin at = tape.origin(node);
  const auto number = [&](const char* text, double value) { return tape.literal(text, value, at); };
  const auto unary = [&](Operation op, NodeId x) { return tape.apply(op, x, x, at); };
  const auto binary = [&](Operation op, NodeId x, NodeId y) { return tape.apply(op, x, y, at); };
  const auto square = [&](NodeId x) { return binary(power, x, number("2", 2)); };
  if (operation == coordinate) return tape.velocity(tape.a(node), at);
  if (operation == time) return number("1", 1);
  const NodeId a = tape.a(node), b = tape.b(node);
  const NodeId da = derivative(a), db = derivative(b);
  if (da == no_node && db == no_node) return no_node;
  switch (operation) {
    case negate:
      return unary(negate, da);
    case add:
    case subtract:
      return sum(operation, da, db, at);
    case multiply: {
      const NodeId left = da == no_node ? no_node : binary(multiply, da, b);
      return sum(add, left, chain(a, db, at), at);
    }
    case divide: {  // (a' - (a/b) b') / b
      if (db == no_node) return binary(divide, da, b);
      return binary(divide, sum(subtract, da, binary(multiply, node, db), at), b);
    }
    case power:
      return power_rule(node, at);
    case sin:
      return chain(unary(cos, a), da, at);
    case cos:
      return unary(negate, chain(unary(sin, a), da, at));
    case tan:
      return chain(binary(add, number("1", 1), square(node)), da, at);
    case asin:
      return binary(divide, da, unary(sqrt, binary(subtract, number("1", 1), square(a))));
    case acos:
      return unary(negate, binary(divide, da, unary(sqrt, binary(subtract, number("1", 1), square(a)))));
    case atan:
      return binary(divide, da, binary(add, number("1", 1), square(a)));
    case atan2: {  // (a' b - a b') / (a² + b²)
      const NodeId top = sum(subtract, chain(b, da, at), chain(a, db, at), at);
      return binary(divide, top, binary(add, square(a), square(b)));
    }
    case sinh:
      return chain(unary(cosh, a), da, at);
    case cosh:
      return chain(unary(sinh, a), da, at);
    case tanh:
      return chain(binary(subtract, number("1", 1), square(node)), da, at);
    case exp:
      return chain(node, da, at);
    case log:
      return binary(divide, da, a);
    case sqrt:
      return binary(divide, da, binary(multiply, number("2", 2), node));
    case abs:
      return chain(unary(sign, a), da, at);
    case min:
    case max: {
      const NodeId first = operation == max ? binary(subtract, a, b) : binary(subtract, b, a);
      const NodeId left = da == no_node ? no_node : binary(where_not_negative, first, da);
      return sum(add, left, db == no_node ? no_node : binary(where_negative, first, db), at);
    }
    case where_not_negative:
    case where_negative:
      return db == no_node ? no_node : binary(operation, a, db);
    default:
      return no_node;  // sign
  }
}

NodeId TotalDerivative::power_rule(NodeId node, Origin at) {
  using enum Operation;
  Tape& tape = *tape_;
  const NodeId a = tape.a(node), b = tape.b(node), da = derivative(a), db = derivative(b);
  NodeId by_base = no_node, by_exponent = no_node;
  if (da != no_node) {  // b a^(b-1) a'; the exponents 0, 1 and 2 are written out
    const double exponent = tape.is_constant(b) ? tape.constant(b) : -1;
    if (exponent == 0) return no_node;
    if (exponent == 1) return da;
    const NodeId one = tape.literal("1", 1, at);
    const NodeId reduced = exponent == 2 ? a : tape.apply(power, a, tape.apply(subtract, b, one, at), at);
    by_base = chain(tape.apply(multiply, b, reduced, at), da, at);
  }
  if (db != no_node) by_exponent = chain(tape.apply(multiply, node, tape.apply(log, a, a, at), at), db, at);
  return sum(add, by_base, by_exponent, at);
}

}  // namespace mechanics::expression
