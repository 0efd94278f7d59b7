#include "convex/functions/node.hpp"

#include <cmath>

#include "convex/composite/graph_form.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

namespace convex {

Value FunctionNode::evaluate(const Vector& x) const {
  constexpr double roundings_of_a_value = 4;
  const double found = value(x);
  return {found, std::isfinite(found) ? roundings_of_a_value * unit_roundoff * std::abs(found) : 0};
}

std::optional<LinearQuadratic> FunctionNode::linear_quadratic(Index) const { return std::nullopt; }

std::optional<GraphForm> FunctionNode::graph(Index) const { return std::nullopt; }

}  // namespace convex
