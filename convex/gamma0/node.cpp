#include "convex/gamma0/node.hpp"

#include <algorithm>
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

/// A slope made of others, as that of an average, is right to so many roundings of itself.
constexpr double roundings_of_a_slope = 64;

/// Of a function of one entry.
std::optional<double> slope_at(const FunctionNode& f, double x) {
  const std::optional<Vector> v = f.subgradient(Vector::Constant(1, x));
  return v && std::isfinite((*v)[0]) ? std::optional((*v)[0]) : std::nullopt;
}

}  // namespace

Value FunctionNode::evaluate(const Vector& x) const {
  const double found = value(x);
  return sum_of_terms(found, std::abs(found));
}

double FunctionNode::error_of_slope(double x, double /*w*/) const {
  return roundings_of_a_slope * unit_roundoff * std::abs(slope_at(*this, x).value_or(0));
}

double error_of_moved_slope(const FunctionNode& f, double x, double moved, double w) {
  if (!(moved > 0)) return 0;
  constexpr double all = std::numeric_limits<double>::infinity();
  const auto before = slope_at(f, std::min(x - moved, std::nextafter(x, -all))),
             after = slope_at(f, std::max(x + moved, std::nextafter(x, all)));
  return before && after ? std::min(w * moved, std::abs(*after - *before)) : w * moved;
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
