#include "mechanics/expression/gradient_nodes.hpp"

#include <algorithm>
#include <unordered_map>

#include "convex/invalid_input.hpp"

namespace mechanics::expression {
namespace {

/// The non-constant nodes below a root, operands first.
std::vector<NodeId> varying_below(const Tape& tape, NodeId root) {
  std::vector<bool> seen(root + 1);
  std::vector<NodeId> found, open{root};
  while (!open.empty()) {
    const NodeId node = open.back();
    open.pop_back();
    if (seen[node] || tape.is_constant(node)) continue;
    seen[node] = true;
    found.push_back(node);
    if (arity(tape.operation(node)) >= 1) open.push_back(tape.a(node));
    if (arity(tape.operation(node)) == 2) open.push_back(tape.b(node));
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// The reverse sweep: `adjoint` of a node is ∂root/∂node.
class Sweep {
 public:
  Sweep(Tape& tape, NodeId root) : tape_(&tape) { adjoint_[root] = number("1", 1, tape.origin(root)); }

  NodeId adjoint(NodeId node) const {
    const auto found = adjoint_.find(node);
    return found == adjoint_.end() ? no_node : found->second;
  }
  void pass_down(NodeId node);

 private:
  NodeId number(const char* text, double value, Origin at) { return tape_->literal(text, value, at); }
  NodeId unary(Operation op, NodeId x) { return tape_->apply(op, x, x, at_); }
  NodeId binary(Operation op, NodeId x, NodeId y) { return tape_->apply(op, x, y, at_); }
  NodeId square(NodeId x) { return binary(Operation::power, x, number("2", 2, at_)); }
  NodeId one() { return number("1", 1, at_); }
  bool is_number(NodeId node, double value) const {
    return tape_->operation(node) == Operation::literal && tape_->constant(node) == value;
  }
  NodeId product(NodeId x, NodeId y) {
    if (is_number(x, 1)) return y;
    if (is_number(y, 1)) return x;
    return binary(Operation::multiply, x, y);
  }
  NodeId negative(NodeId x) { return unary(Operation::negate, x); }
  void give(NodeId operand, NodeId amount) {
    if (tape_->is_constant(operand)) return;
    const auto [place, is_new] = adjoint_.emplace(operand, amount);
    if (!is_new) place->second = binary(Operation::add, place->second, amount);
  }
  /// f of an adjoint, where conditions stay outermost: 0 times what is undefined on a branch that is not
  /// taken would be undefined too.
  template <class Function>
  NodeId behind_conditions(NodeId adjoint, Function f) {
    const Operation operation = tape_->operation(adjoint);
    const NodeId a = tape_->a(adjoint), b = tape_->b(adjoint);
    if (is_where(operation)) return binary(operation, a, behind_conditions(b, f));
    if (operation == Operation::add && (has_condition(a) || has_condition(b)))
      return binary(operation, behind_conditions(a, f), behind_conditions(b, f));
    return f(adjoint);
  }
  bool has_condition(NodeId sum) const {
    while (tape_->operation(sum) == Operation::add) {
      if (has_condition(tape_->b(sum))) return true;
      sum = tape_->a(sum);
    }
    return is_where(tape_->operation(sum));
  }
  NodeId times(NodeId adjoint, NodeId factor) {
    return behind_conditions(adjoint, [&](NodeId mine) { return product(mine, factor); });
  }
  NodeId turned(NodeId adjoint) {
    return behind_conditions(adjoint, [&](NodeId mine) { return negative(mine); });
  }
  NodeId with_factor_replaced(NodeId mine, NodeId a, NodeId by);
  NodeId slope(NodeId node);
  void give_power(NodeId node, NodeId mine);

  Tape* tape_;
  Origin at_;
  std::unordered_map<NodeId, NodeId> adjoint_;
};

/// b a^(b-1) and a^b log a; the exponents 1 and 2 are written out.
void Sweep::give_power(NodeId node, NodeId mine) {
  const NodeId a = tape_->a(node), b = tape_->b(node);
  if (!tape_->is_constant(a)) {
    const double exponent = tape_->is_constant(b) ? tape_->constant(b) : -1;
    if (exponent == 1) give(a, mine);
    if (exponent != 0 && exponent != 1) {
      const NodeId reduced =
          exponent == 2 ? a : binary(Operation::power, a, binary(Operation::subtract, b, one()));
      give(a, times(mine, binary(Operation::multiply, b, reduced)));
    }
  }
  if (!tape_->is_constant(b))
    give(b, times(mine, binary(Operation::multiply, node, unary(Operation::log, a))));
}

/// mine with its factor a replaced: by |a| = a sign(a) or √a = a/√a it is mine × the slope of |a| or 2√a,
/// which a = 0 has none of. no_node where no such factor is seen.
NodeId Sweep::with_factor_replaced(NodeId mine, NodeId a, NodeId by) {
  using enum Operation;
  if (mine == a) return by;
  const Operation operation = tape_->operation(mine);
  if (tape_->is_constant(mine) || arity(operation) == 0) return no_node;
  const NodeId left = tape_->a(mine), right = tape_->b(mine);
  if (operation == Operation::power && left == a && tape_->is_constant(right) &&
      tape_->constant(right) >= 2) {
    const NodeId rest = is_number(right, 2) ? a : binary(power, a, binary(subtract, right, one()));
    return binary(multiply, rest, by);
  }
  if (operation != multiply && operation != divide && operation != negate) return no_node;
  const NodeId found = with_factor_replaced(left, a, by);
  if (operation == negate) return found == no_node ? no_node : negative(found);
  if (found != no_node) return binary(operation, found, right);
  if (operation == divide) return no_node;
  const NodeId other = with_factor_replaced(right, a, by);
  return other == no_node ? no_node : binary(operation, left, other);
}

/// f' of a function of one argument; no_node where it is 0 everywhere.
NodeId Sweep::slope(NodeId node) {
  using enum Operation;
  const NodeId a = tape_->a(node);
  switch (tape_->operation(node)) {
    case sin:
      return unary(cos, a);
    case cos:
      return negative(unary(sin, a));
    case tan:
      return binary(add, one(), square(node));
    case asin:
      return binary(divide, one(), unary(sqrt, binary(subtract, one(), square(a))));
    case acos:
      return negative(binary(divide, one(), unary(sqrt, binary(subtract, one(), square(a)))));
    case atan:
      return binary(divide, one(), binary(add, one(), square(a)));
    case sinh:
      return unary(cosh, a);
    case cosh:
      return unary(sinh, a);
    case tanh:
      return binary(subtract, one(), square(node));
    case exp:
      return node;
    case log:
      return binary(divide, one(), a);
    case sqrt:
      return binary(divide, number("0.5", 0.5, at_), node);
    case sign:
      return no_node;
    default:
      throw convex::InvalidInput("\"" + std::string(symbol(tape_->operation(node))) +
                                 "\" has no derivative in symbols; write the expressions without it");
  }
}

void Sweep::pass_down(NodeId node) {
  using enum Operation;
  const NodeId mine = adjoint(node);
  if (mine == no_node) return;
  at_ = tape_->origin(node);
  const NodeId a = tape_->a(node), b = tape_->b(node);
  switch (tape_->operation(node)) {
    case coordinate:
    case velocity:
    case time:
      return;
    case negate:
      return give(a, turned(mine));
    case Operation::add:
      give(a, mine);
      return give(b, mine);
    case subtract:
      give(a, mine);
      return give(b, turned(mine));
    case multiply:
      give(a, times(mine, b));
      return give(b, times(mine, a));
    case divide: {
      const NodeId share = behind_conditions(mine, [&](NodeId m) { return binary(divide, m, b); });
      give(a, share);
      if (!tape_->is_constant(b)) give(b, turned(times(share, node)));
      return;
    }
    case Operation::power:
      return give_power(node, mine);
    case atan2: {  // (a' b - a b') / (a² + b²)
      const NodeId square_sum = binary(Operation::add, square(a), square(b));
      const NodeId share = behind_conditions(mine, [&](NodeId m) { return binary(divide, m, square_sum); });
      give(a, times(share, b));
      return give(b, turned(times(share, a)));
    }
    case min:
    case max: {
      const NodeId first = tape_->operation(node) == max ? binary(subtract, a, b) : binary(subtract, b, a);
      give(a, binary(where_not_negative, first, mine));
      return give(b, binary(where_negative, first, mine));
    }
    case where_not_negative:
    case where_negative:
      return give(b, binary(tape_->operation(node), a, mine));
    case abs:
      return give(a, behind_conditions(mine, [&](NodeId m) {
                    const NodeId found = with_factor_replaced(m, a, node);
                    return found == no_node ? product(m, unary(sign, a)) : found;
                  }));
    case Operation::sqrt:
      return give(a, behind_conditions(mine, [&](NodeId m) {
                    const NodeId found = with_factor_replaced(m, a, node);
                    return found == no_node ? product(m, slope(node))
                                            : product(number("0.5", 0.5, at_), found);
                  }));
    default:
      if (const NodeId rate = slope(node); rate != no_node) give(a, times(mine, rate));
  }
}

}  // namespace

GradientNodes gradient_nodes(Tape& tape, NodeId root) {
  const std::vector<NodeId> below = varying_below(tape, root);
  GradientNodes found;
  if (below.empty()) return found;
  Sweep sweep(tape, root);
  for (std::size_t k = below.size(); k-- > 0;) sweep.pass_down(below[k]);
  for (const NodeId node : below) {
    const NodeId adjoint = sweep.adjoint(node);
    if (adjoint == no_node) continue;
    if (tape.operation(node) == Operation::coordinate)
      found.by_coordinate.emplace_back(tape.a(node), adjoint);
    if (tape.operation(node) == Operation::time) found.by_time = adjoint;
    if (tape.operation(node) == Operation::velocity) found.by_velocity.emplace_back(tape.a(node), adjoint);
  }
  std::sort(found.by_coordinate.begin(), found.by_coordinate.end());
  std::sort(found.by_velocity.begin(), found.by_velocity.end());
  return found;
}

}  // namespace mechanics::expression
