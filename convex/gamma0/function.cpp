#include "convex/gamma0/function.hpp"

#include <cmath>
#include <string>

#include "convex/counted.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"

namespace convex::inline gamma0 {
namespace {

/// Of the work of a question, what a value by itself may take.
constexpr double part_of_a_value_alone = 0.25;

/// Throws InvalidInput unless x can be an argument of f.
void check(const Function& f, const Vector& x, const char* what) {
  const Index n = f.dimension();
  if (x.size() == 0) throw InvalidInput(f.call().name + ": " + what + " has no entries; give at least one");
  if (n != 0 && x.size() != n)
    throw InvalidInput(f.call().name + ": " + what + " has " + counted(x.size(), "entry", "entries") +
                       ", the function takes " + std::to_string(n) + "; give as many");
  f.node().require_size(x.size());
  for (Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]))
      throw InvalidInput(f.call().name + ": entry " + std::to_string(i) + " of " + what +
                         " is not finite; give numbers");
}

/// A result that is nothing but the rounding of z lies on no side of a set whose boundary passes 0; where 0
/// itself is in the domain, it is the answer, and the bound says what was left out.
void settle_at_zero(const FunctionNode& f, const Vector& z, const Metric& W, Prox& found) {
  constexpr double roundings = 64 * unit_roundoff, negligible = 1e-13;
  if (found.x.isZero(0)) return;
  const double length = W.norm(found.x), size = W.norm(z);
  const double rounding = roundings * static_cast<double>(z.size()) * W.factor_condition() * size;
  if (!std::isfinite(rounding)) return;  // squares overflow: nothing is known of what is small beside it
  if (!(length <= std::max(rounding, found.error_bound))) return;
  const double here = f.value(found.x), at_zero = f.value(Vector::Zero(z.size()));
  if (!std::isfinite(at_zero) || at_zero > here) return;
  if (std::isfinite(here) && (found.method == "closed form" || length > negligible * size)) return;
  found.x.setZero();
  found.values.reset();
  found.error_bound += length;
}

/// Norms by a rounded factor of a full W are right to such a part of themselves, which bounds are short of
/// where W is nearly singular.
double rounding_of_norms(const Metric& W) {
  if (W.kind() != MetricKind::dense) return 0;
  constexpr double roundings = 4;
  const double condition = W.factor_condition();
  return roundings * static_cast<double>(W.dimension()) * unit_roundoff * condition * condition;
}

}  // namespace

Index Function::dimension() const { return node_->dimension(); }

Facts Function::facts() const { return node_->facts(); }

Call Function::call() const { return node_->call(); }

double Function::operator()(const Vector& x) const {
  check(*this, x, "x");
  const WorkLimit question(part_of_a_value_alone);
  return node_->value(x);
}

Value Function::evaluate(const Vector& x) const {
  check(*this, x, "x");
  const WorkLimit question(part_of_a_value_alone);
  const Value found = node_->evaluate(x);
  if (std::isfinite(found.value)) return found;
  // A function that is finite everywhere has left the doubles, and so have terms that cancel to nothing.
  if (std::isnan(found.value)) return {infinity, infinity};
  return {found.value, node_->facts().finite ? infinity : found.error};
}

Prox Function::prox(const Vector& z, const Metric& W, const Look& look) const {
  check(*this, z, "z");
  if (W.dimension() != z.size())
    throw InvalidInput(call().name + ": z has " + counted(z.size(), "entry", "entries") + ", the metric " +
                       counted(W.dimension(), "row", "rows") + "; give one of the other's size");
  const WorkLimit question;
  Prox found = node_->prox(z, W, look);
  if (found.x.size() == z.size()) settle_at_zero(*node_, z, W, found);
  found.error_bound *= 1 + rounding_of_norms(W);
  if (found.status == Status::solved && !std::isfinite(found.error_bound)) found.status = Status::inaccurate;
  return found;
}

Function Function::conjugate() const { return node_->conjugate(); }

std::optional<Vector> Function::subgradient(const Vector& x) const {
  check(*this, x, "x");
  return node_->subgradient(x);
}

bool Function::is_subgradient(const Vector& v, const Vector& x) const {
  check(*this, x, "x");
  check(*this, v, "v");
  if (v.size() != x.size())
    throw InvalidInput(call().name + ": v and x differ in size; give one of the other's size");
  const Prox back = node_->prox(x + v, Metric::identity(x.size()), {});
  if (back.x.size() != x.size()) return false;
  return (back.x - x).norm() <= membership_tolerance * (x.norm() + v.norm());
}

}  // namespace convex::inline gamma0
