#include "mechanics/expression/degree.hpp"

#include <algorithm>
#include <cmath>

namespace mechanics::expression {
namespace {

constexpr int not_a_polynomial = 1000;  // and all degrees that are as large

int degree(const Tape& tape, NodeId node, const std::vector<int>& of) {
  using enum Operation;
  const Operation operation = tape.operation(node);
  if (operation == velocity) return 1;
  if (arity(operation) == 0 || (tape.depends(node) & on_velocities) == 0) return 0;
  const NodeId a = tape.a(node), b = tape.b(node);
  switch (operation) {
    case negate:
      return of[a];
    case add:
    case subtract:
      return std::max(of[a], of[b]);
    case multiply:
      return std::min(of[a] + of[b], not_a_polynomial);
    case divide:
      return of[b] == 0 ? of[a] : not_a_polynomial;
    case power: {
      if (of[a] == 0 && of[b] == 0) return 0;
      const double exponent = tape.is_constant(b) ? tape.constant(b) : -1;
      if (!(exponent >= 0) || exponent != std::floor(exponent)) return not_a_polynomial;
      return static_cast<int>(std::min(of[a] * exponent, double{not_a_polynomial}));
    }
    case where_not_negative:
    case where_negative:
      return of[a] == 0 ? of[b] : not_a_polynomial;
    default:
      return of[a] == 0 && of[b] == 0 ? 0 : not_a_polynomial;
  }
}

}  // namespace

Degrees velocity_degrees(const Tape& tape, NodeId root) {
  Degrees degrees;
  degrees.of.assign(root + std::size_t{1}, 0);
  std::vector<bool> needed(root + std::size_t{1});
  needed[root] = true;
  for (NodeId node = root + 1; node-- > 0;) {
    if (!needed[node] || arity(tape.operation(node)) == 0) continue;
    needed[tape.a(node)] = true;
    if (arity(tape.operation(node)) == 2) needed[tape.b(node)] = true;
  }
  for (NodeId node = 0; node <= root; ++node) {
    if (!needed[node]) continue;
    degrees.of[node] = degree(tape, node, degrees.of);
    if (degrees.of[node] > 2 && degrees.offending == no_node) degrees.offending = node;
  }
  if (degrees.of[root] <= 2) degrees.offending = no_node;
  return degrees;
}

}  // namespace mechanics::expression
