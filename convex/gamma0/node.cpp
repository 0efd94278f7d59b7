#include "convex/gamma0/node.hpp"

#include <cmath>
#include <limits>

#include "convex/composite/graph_form.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"

namespace convex::inline gamma0 {

namespace {

/// An upper bound of a support function. Of one entry it is a weight times |d| on each side: at d = ±1 a
/// formula has nothing to round, and whether an end of a domain is another's is decided by its last digit.
double on_direction(const FunctionNode& support, const Vector& d) {
  const Value found = support.evaluate(d);
  const bool by_formula = found.error <= sum_of_terms(found.value, std::abs(found.value)).error;
  if (d.size() == 1 && std::abs(d[0]) == 1 && by_formula) return found.value;
  return found.value + found.error;
}

}  // namespace

Value FunctionNode::evaluate(const Vector& x) const {
  const double found = value(x);
  return sum_of_terms(found, std::abs(found));
}

std::optional<Function> FunctionNode::entry(Index) const {
  if (dimension() != 0 || !facts().separable) return std::nullopt;
  return Function(shared_from_this());
}

double FunctionNode::recession(const Vector& d) const {
  if (d.isZero(0)) return 0;
  if (!facts().support) return std::numeric_limits<double>::infinity();
  return on_direction(*this, d);
}

double FunctionNode::domain_support(const Vector& v) const {
  if (v.isZero(0)) return 0;
  const Facts known = facts();
  if (known.finite || !known.indicator) return std::numeric_limits<double>::infinity();
  return on_direction(conjugate().node(), v);
}

std::optional<LinearQuadratic> FunctionNode::linear_quadratic(Index) const { return std::nullopt; }

std::optional<GraphForm> FunctionNode::graph(Index, double) const { return std::nullopt; }

}  // namespace convex::inline gamma0
