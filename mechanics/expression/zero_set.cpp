#include "mechanics/expression/zero_set.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace mechanics::expression {
namespace {

bool is_zero(const Tape& tape, NodeId node) {
  return tape.operation(node) == Operation::literal && tape.constant(node) == 0;
}

bool is_factor(const Tape& tape, NodeId node) {
  return tape.is_constant(node) && std::isfinite(tape.constant(node)) && tape.constant(node) != 0;
}

/// Factors with their exponents, in the order in which they stand, numbers left out.
using Factors = std::vector<std::pair<NodeId, double>>;

void gather(const Tape& tape, NodeId f, double times, Factors& found) {
  const NodeId a = tape.a(f), b = tape.b(f);
  const Operation operation = tape.operation(f);
  if (is_factor(tape, f)) return;
  if (operation == Operation::negate || (operation == Operation::divide && is_factor(tape, b)) ||
      (operation == Operation::subtract && is_zero(tape, b)))
    return gather(tape, a, times, found);
  if (operation == Operation::subtract && is_zero(tape, a)) return gather(tape, b, times, found);
  if (operation == Operation::multiply) {
    gather(tape, a, times, found);
    return gather(tape, b, times, found);
  }
  if (operation == Operation::power && tape.is_constant(b) && tape.constant(b) >= 1)
    return gather(tape, a, times * tape.constant(b), found);
  for (auto& [factor, exponent] : found)
    if (factor == f) {
      exponent += times;
      return;
    }
  found.emplace_back(f, times);
}

}  // namespace

NodeId base_of_power(Tape& tape, NodeId f) {
  if (tape.is_constant(f)) return f;
  Factors factors;
  gather(tape, f, 1, factors);
  bool is_power = false;
  for (const auto& [factor, exponent] : factors) {
    if (tape.is_constant(factor)) return f;
    is_power = is_power || exponent > 1;
  }
  if (!is_power) return f;
  NodeId product = factors.front().first;
  for (std::size_t k = 1; k < factors.size(); ++k)
    product = tape.apply(Operation::multiply, product, factors[k].first, tape.origin(f));
  return product;
}

}  // namespace mechanics::expression
