#include "convex/functions/node.hpp"

#include "convex/composite/graph_form.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

namespace convex {

std::optional<LinearQuadratic> FunctionNode::linear_quadratic(Index) const { return std::nullopt; }

std::optional<GraphForm> FunctionNode::graph(Index) const { return std::nullopt; }

}  // namespace convex
