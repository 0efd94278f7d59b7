#include "convex/functions/program_function.hpp"

#include <cmath>
#include <limits>

#include "convex/composite/graph_algebra.hpp"
#include "convex/functions/closed_form.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/prox.hpp"
#include "convex/linear_quadratic/value.hpp"

namespace convex::inline named_functions {
namespace {

/// One side of the pair; `swapped` is the conjugate.
class ProgramNode : public FunctionNode {
 public:
  ProgramNode(std::shared_ptr<const ProgramFunction> parts, bool swapped)
      : parts_(std::move(parts)), swapped_(swapped) {}
  Index dimension() const override { return form().n; }
  Facts facts() const override {
    Facts facts = swapped_ ? parts_->conjugate_facts : parts_->facts;
    facts.piecewise_quadratic = true;
    return facts;
  }
  Call call() const override { return swapped_ ? parts_->conjugate_call : parts_->call; }
  double value(const Vector& x) const override { return convex::value(form(), x); }
  Value evaluate(const Vector& x) const override {
    const Evaluation found = convex::evaluate(form(), x);
    if (found.status != Status::solved) return {std::numeric_limits<double>::quiet_NaN(), 0};
    Value value = sum_of_terms(found.value, std::abs(found.value));
    if (std::isinf(found.error)) value.error = found.error;
    return value;
  }
  Prox prox(const Vector& z, const Metric& W, const Look&) const override {
    return without_rounding_at_zero(convex::prox(form(), z, W), facts(), z, W);
  }
  Function conjugate() const override { return Function(std::make_shared<ProgramNode>(parts_, !swapped_)); }
  std::optional<Vector> subgradient(const Vector& x) const override { return convex::evaluate(form(), x).v; }
  double recession(const Vector& d) const override { return known_or_infinite(form(), d); }
  double domain_support(const Vector& v) const override {
    return known_or_infinite(swapped_ ? parts_->form : parts_->conjugate_form, v);
  }
  std::optional<LinearQuadratic> linear_quadratic(Index) const override { return form(); }
  std::optional<GraphForm> graph(Index, double) const override {
    return swapped_ ? convex::conjugate(parts_->graph) : parts_->graph;
  }

 private:
  /// A recession function's value.
  static double known_or_infinite(const LinearQuadratic& f, const Vector& d) {
    const double found = convex::value(convex::linear_quadratic::recession(f), d);
    return std::isnan(found) ? std::numeric_limits<double>::infinity() : found;
  }
  const LinearQuadratic& form() const { return swapped_ ? parts_->conjugate_form : parts_->form; }
  std::shared_ptr<const ProgramFunction> parts_;
  bool swapped_;
};

}  // namespace

Function program_function(ProgramFunction parts) {
  return Function(
      std::make_shared<ProgramNode>(std::make_shared<const ProgramFunction>(std::move(parts)), false));
}

}  // namespace convex::inline named_functions
