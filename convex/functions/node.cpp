#include "convex/functions/node.hpp"

#include "convex/composite/graph_form.hpp"
#if __has_include("convex/linear_quadratic/linear_quadratic.hpp")
#include "convex/linear_quadratic/linear_quadratic.hpp"
#else
namespace convex {
struct LinearQuadratic {};
}  // namespace convex
#endif

namespace convex {

std::optional<LinearQuadratic> FunctionNode::linear_quadratic(Index) const { return std::nullopt; }

std::optional<GraphForm> FunctionNode::graph(Index) const { return std::nullopt; }

}  // namespace convex
