#include "convex/gamma0/node.hpp"

#include <cmath>
#include <limits>

#include "convex/composite/graph_form.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

namespace convex::inline gamma0 {

Value FunctionNode::evaluate(const Vector& x) const {
  constexpr double roundings_of_a_value = 4;
  const double found = value(x);
  return {found, std::isfinite(found) ? roundings_of_a_value * unit_roundoff * std::abs(found) : 0};
}

std::optional<Function> FunctionNode::entry(Index) const {
  if (dimension() != 0 || !facts().separable) return std::nullopt;
  return Function(shared_from_this());
}

double FunctionNode::recession(const Vector& d) const {
  if (d.isZero(0)) return 0;
  if (!facts().support) return std::numeric_limits<double>::infinity();
  const Value found = evaluate(d);
  return found.value + found.error;
}

double FunctionNode::domain_support(const Vector& v) const {
  if (v.isZero(0)) return 0;
  const Facts known = facts();
  if (known.finite || !known.indicator) return std::numeric_limits<double>::infinity();
  const Value found = conjugate().evaluate(v);
  return found.value + found.error;
}

std::optional<LinearQuadratic> FunctionNode::linear_quadratic(Index) const { return std::nullopt; }

std::optional<GraphForm> FunctionNode::graph(Index, double) const { return std::nullopt; }

}  // namespace convex::inline gamma0
