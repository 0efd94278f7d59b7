#include "convex/functions/program_function.hpp"

#include <cmath>
#include <limits>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/double_double.hpp"
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
  double value(const Vector& x) const override { return evaluate(x).value; }
  Value evaluate(const Vector& x) const override {
    if (const auto formula = by_formula(x)) return formula->value;
    const linear_quadratic::Evaluation found = linear_quadratic::evaluate(form(), x);
    if (found.status != Status::solved) {
      constexpr double infinite = std::numeric_limits<double>::infinity();
      return {infinite, infinite};
    }
    Value value = sum_of_terms(found.value, std::abs(found.value));
    value.error += found.error;
    return value;
  }
  Prox prox(const Vector& z, const Metric& W, const Look&) const override {
    return without_rounding_at_zero(linear_quadratic::prox(form(), z, W), facts(), z, W);
  }
  Function conjugate() const override { return Function(std::make_shared<ProgramNode>(parts_, !swapped_)); }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (const auto formula = by_formula(x); formula && formula->v) return formula->v;
    return linear_quadratic::evaluate(form(), x).v;
  }
  double recession(const Vector& d) const override { return known_or_infinite(form(), d); }
  double domain_support(const Vector& v) const override {
    return known_or_infinite(swapped_ ? parts_->form : parts_->conjugate_form, v);
  }
  std::optional<LinearQuadratic> linear_quadratic(Index) const override { return form(); }
  std::optional<GraphForm> graph(Index, double) const override {
    return swapped_ ? convex::conjugate(parts_->graph) : parts_->graph;
  }

 private:
  struct ValueAndSlope {
    Value value;
    std::optional<Vector> v;
  };
  /// f finite everywhere and of the form f_1(Mx + b), f_1 with a formula, Mx + b summed in twice the
  /// precision.
  std::optional<ValueAndSlope> by_formula(const Vector& x) const {
    const GraphForm& graph = parts_->graph;
    if (swapped_ || !parts_->facts.finite || graph.k != 0 || graph.terms.size() != 1 || graph.constant != 0)
      return std::nullopt;
    const GraphTerm& term = graph.terms[0];
    DoubleDoubleVector sum(term.b);
    for (Index j = 0; j < term.M.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(term.M, j); it; ++it) {
        const DoubleDouble more = add({sum.hi[it.row()], sum.lo[it.row()]}, two_product(it.value(), x[j]));
        sum.hi[it.row()] = more.hi;
        sum.lo[it.row()] = more.lo;
      }
    const Vector at = sum.value();
    const Value of_term = term.f->evaluate(at);
    const std::optional<Vector> slope = term.f->subgradient(at);
    if (!std::isfinite(of_term.value) || !slope || !at.allFinite()) return std::nullopt;
    Value found = multiple_of(term.scale, of_term);
    found.error += unit_roundoff * term.scale * slope->cwiseAbs().dot(at.cwiseAbs());
    return ValueAndSlope{found, Vector(term.scale * (term.M.transpose() * *slope))};
  }

  /// A recession function's value.
  static double known_or_infinite(const LinearQuadratic& f, const Vector& d) {
    const double found = linear_quadratic::value(linear_quadratic::recession(f), d);
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
