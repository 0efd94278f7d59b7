#include <algorithm>
#include <cmath>

#include "convex/composite/composite_prox.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/value.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/supremum.hpp"
#include "convex/operations/two_function_max.hpp"

namespace convex::inline operations {
namespace {

class ComputedConjugate : public Operation {
 public:
  explicit ComputedConjugate(Function f) : f_(std::move(f)) {}
  Index dimension() const override { return f_.dimension(); }
  void require_size(Index n) const override { f_.node().require_size(n); }
  Facts facts() const override {
    const Facts f = f_.facts();
    return {.indicator = f.support,
            .cone = f.cone,
            .support = f.indicator,
            .separable = f.separable,
            .piecewise_quadratic = f.piecewise_quadratic};
  }
  Call call() const override { return {"conjugate", {argument(f_.call())}}; }
  Function conjugate() const override { return f_; }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto form = f_.node().linear_quadratic(n);
    if (!form) return std::nullopt;
    return linear_quadratic::conjugate(*form);
  }
  /// By a program; of a maximum by its dual too, where that leaves the value open.
  Value evaluate(const Vector& v) const override {
    const Value found = by_programs(v);
    const std::vector<Function> maximum = parts_of_max(f_);
    if (maximum.empty() || WorkLimit::passed() ||
        found.error <= roundings * unit_roundoff * (1 + std::abs(found.value)))
      return found;
    const auto part = WorkLimit::half_of_the_rest();
    const auto other = conjugate_of_max(maximum, v);
    return other && other->error < found.error ? *other : found;
  }
  double recession(const Vector& d) const override { return f_.node().domain_support(d); }
  double domain_support(const Vector& v) const override { return f_.node().recession(v); }
  /// A point of f* is a slope of f.
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto form = f_.node().graph(n, -slope);
    if (!form) return std::nullopt;
    return convex::conjugate(*form);
  }

 protected:
  /// The covector of f at its point is the point of f*, and the other way round.
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    return by_moreau(
        [&](const Vector& point, const Metric& V) { return std::optional(f_.prox(point, V, look)); }, z, W);
  }

 private:
  static constexpr double roundings = 64;

  /// In units of the slope v where heights are measured: a small v may be the sum of slopes that cancel, and
  /// units far below theirs hide that a part is missed.
  Value by_programs(const Vector& v) const {
    const auto* parts = dynamic_cast<const Operation*>(&f_.node());
    if (parts)
      if (const auto found = parts->conjugate_value(v); found && std::isfinite(found->value))
        return settled_value(*found, {}, f_, v);
    const double unit = parts && v.norm() > 0 ? unit_of_slope(parts->slope_of(v)) : 1;
    const auto in_units = unit != 1 ? in_units_of(unit, *parts, v) : std::nullopt;
    if (!in_units || unit > 1) {
      const ByProgram found = in_units ? *in_units : by_program(v);
      return settled_value(found.value, found.slope, f_, v);
    }
    const ByProgram plain = by_program(v), found = held_against(*in_units, plain);
    const Value settled = settled_value(found.value, found.slope, f_, v);
    return is_known(settled) || !is_known(plain.value) ? settled : plain.value;
  }
  /// Leaves work for the other ways.
  std::optional<ByProgram> in_units_of(double unit, const Operation& parts, const Vector& v) const {
    if (facts().piecewise_quadratic) return std::nullopt;
    const auto form = parts.graph(v.size(), unit);
    if (!form) return std::nullopt;
    const auto part = WorkLimit::half_of_the_rest();
    const GraphValue found = convex::evaluate(convex::conjugate(*form), v);
    return ByProgram{value_of(found), found.v};
  }
  static bool is_known(const Value& value) {
    return std::isfinite(value.value) && std::isfinite(value.error);
  }
  static ByProgram held_against(ByProgram found, const ByProgram& plain) {
    if (std::isfinite(plain.value.value) && !std::isfinite(found.value.value)) return plain;
    const double apart = std::abs(found.value.value - plain.value.value);
    const double size = 1 + std::abs(found.value.value) + std::abs(plain.value.value);
    const double open = found.value.error + plain.value.error + roundings * unit_roundoff * size;
    if (apart > open) found.value.error = std::max(found.value.error, apart);
    return found;
  }

  Function f_;
};

}  // namespace

std::optional<Function> primal_of(const Function& h) {
  if (const auto* node = dynamic_cast<const ComputedConjugate*>(&h.node())) return node->conjugate();
  return std::nullopt;
}

Function computed_conjugate(const Function& f) {
  if (const auto primal = primal_of(f)) return *primal;
  return Function(std::make_shared<ComputedConjugate>(f));
}

}  // namespace convex::inline operations
