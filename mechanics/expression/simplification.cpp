#include "mechanics/expression/simplification.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace mechanics::expression {

std::string shortest_digits(double x) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr};
}

NodeId Simplification::operator()(NodeId root) {
  known_.resize(from_->size(), no_node);
  std::vector<NodeId> open{root};
  while (!open.empty()) {
    const NodeId node = open.back();
    if (known_[node] != no_node) {
      open.pop_back();
      continue;
    }
    const std::size_t before = open.size();
    const bool whole = numbers_ && from_->is_constant(node);
    const Operation operation = from_->operation(node);
    if (!whole && arity(operation) >= 1 && known_[from_->a(node)] == no_node) open.push_back(from_->a(node));
    if (!whole && arity(operation) == 2 && known_[from_->b(node)] == no_node) open.push_back(from_->b(node));
    if (open.size() > before) continue;
    known_[node] = copied(node);
    open.pop_back();
  }
  return known_[root];
}

NodeId Simplification::copied(NodeId node) {
  at_ = from_->origin(node);
  if (numbers_ && from_->is_constant(node)) return number(from_->constant(node));
  const Operation operation = from_->operation(node);
  switch (operation) {
    case Operation::literal:
      return number(from_->constant(node));
    case Operation::pi:
      return to_->pi(at_);
    case Operation::coordinate:
      return to_->coordinate(from_->a(node), at_);
    case Operation::velocity:
      return to_->velocity(from_->a(node), at_);
    case Operation::time:
      return to_->time(at_);
    case Operation::parameter:  // its name stands for it
      return to_->parameter(from_->text(node), known_[from_->a(node)], at_);
    default:
      return rebuilt(operation, known_[from_->a(node)],
                     known_[arity(operation) == 2 ? from_->b(node) : from_->a(node)]);
  }
}

NodeId Simplification::number(double value) {
  if (value < 0) return negative(number(-value));
  return to_->literal(shortest_digits(value), value, at_);
}

bool Simplification::is(NodeId node, double value) const {
  return is_number(node) && to_->constant(node) == value;
}

NodeId Simplification::negative(NodeId x) {
  if (is_negative(x)) return to_->a(x);
  if (is(x, 0)) return x;
  if (to_->operation(x) == Operation::subtract)
    return to_->apply(Operation::subtract, to_->b(x), to_->a(x), at_);
  return to_->apply(Operation::negate, x, x, at_);
}

NodeId Simplification::product(NodeId a, NodeId b) {
  if (is(a, 0)) return a;
  if (is(b, 0)) return b;
  if (is(a, 1)) return b;
  if (is(b, 1)) return a;
  if (is_negative(a)) return negative(product(to_->a(a), b));
  if (is_negative(b)) return negative(product(a, to_->a(b)));
  if (is_number(a) && is_number(b)) {
    const double x = to_->constant(a), y = to_->constant(b), xy = x * y;
    if (std::isfinite(xy) && std::fma(x, y, -xy) == 0) return number(xy);
  }
  // 2 (x/2) is x.
  if (to_->operation(a) == Operation::divide && to_->b(a) == b) return to_->a(a);
  if (to_->operation(b) == Operation::divide && to_->b(b) == a) return to_->a(b);
  if (to_->operation(b) == Operation::multiply && is_number(a) && !is_number(to_->a(b)) &&
      to_->operation(to_->a(b)) == Operation::divide && to_->b(to_->a(b)) == a)
    return product(to_->a(to_->a(b)), to_->b(b));
  return to_->apply(Operation::multiply, a, b, at_);
}

NodeId Simplification::sum(NodeId a, NodeId b) {
  if (is(a, 0)) return b;
  if (is(b, 0)) return a;
  if (is_negative(b)) return difference(a, to_->a(b));
  if (is_negative(a)) return difference(b, to_->a(a));
  return to_->apply(Operation::add, a, b, at_);
}

NodeId Simplification::difference(NodeId a, NodeId b) {
  if (is(b, 0)) return a;
  if (is(a, 0)) return negative(b);
  if (a == b) return number(0);
  if (is_negative(b)) return sum(a, to_->a(b));
  if (is_negative(a)) return negative(sum(to_->a(a), b));
  if (is_number(a) && is_number(b) && to_->constant(a) == 2 && to_->constant(b) == 1) return number(1);
  return to_->apply(Operation::subtract, a, b, at_);
}

NodeId Simplification::quotient(NodeId a, NodeId b) {
  if (is(a, 0) && !is(b, 0)) return a;
  if (is(b, 1)) return a;
  if (is_negative(a)) return negative(quotient(to_->a(a), b));
  if (is_negative(b)) return negative(quotient(a, to_->a(b)));
  return to_->apply(Operation::divide, a, b, at_);
}

NodeId Simplification::rebuilt(Operation operation, NodeId a, NodeId b) {
  switch (operation) {
    case Operation::negate:
      return negative(a);
    case Operation::add:
      return sum(a, b);
    case Operation::subtract:
      return difference(a, b);
    case Operation::multiply:
      return product(a, b);
    case Operation::divide:
      return quotient(a, b);
    case Operation::power:
      if (is(b, 0)) return number(1);
      if (is(b, 1)) return a;
      if (is(b, 2) && is_negative(a)) a = to_->a(a);
      return to_->apply(operation, a, b, at_);
    case Operation::where_not_negative:
    case Operation::where_negative:
      if (is(b, 0)) return b;
      return to_->apply(operation, a, b, at_);
    default:
      return to_->apply(operation, a, b, at_);
  }
}

}  // namespace mechanics::expression
