#include "convex/composite/affine_atoms.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/merged_vector.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/reduction.hpp"
#include "convex/operations/two_function_max.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

class Tilt : public Operation {
 public:
  Tilt(Function f, MergedVector c) : f_(std::move(f)), merged_(std::move(c)), c_(merged_.value()) {}
  const Function& part() const { return f_; }
  const MergedVector& c() const { return merged_; }

  Index dimension() const override { return c_.size(); }
  Facts facts() const override {
    Facts facts = f_.facts();
    facts.indicator = facts.cone = facts.radial = false;
    return facts;
  }
  Call call() const override {
    Call made = f_.call();
    for (const Vector& c : merged_.terms()) made = {"tilt", {argument(made), argument("c", c)}};
    return made;
  }
  Value evaluate(const Vector& x) const override {
    return sum_of(f_.evaluate(x), sum_of(product(c_, x), product(merged_.rest(), x)));
  }
  std::optional<Value> evaluate_pair(const DoubleDoubleVector& x) const override {
    return sum_of(value_near(f_, x, 0),
                  sum_of(product(c_, x.hi), sum_of(product(c_, x.lo), product(merged_.rest(), x.hi))));
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    std::optional<Vector> v = f_.subgradient(x);
    if (v) *v += c_;
    return v;
  }
  double error_of_slope(double x, double w) const override {
    return f_.node().error_of_slope(x, w) + unit_roundoff * std::abs(c_[0]);
  }
  Function conjugate() const override {
    Function made = f_.conjugate();
    for (const Vector& c : merged_.terms()) made = translate(made, c);
    return made;
  }
  std::vector<Function> maximum_of() const override {
    std::vector<Function> parts = parts_of_max(f_);
    for (Function& part : parts) part = tilt(part, c_);
    return parts;
  }
  double recession(const Vector& d) const override { return f_.node().recession(d) + c_.dot(d); }
  double domain_support(const Vector& v) const override { return f_.node().domain_support(v); }
  std::optional<Function> entry(Index i) const override {
    const auto f = f_.node().entry(i);
    return f ? std::optional(tilt(*f, c_.segment(i, 1))) : std::nullopt;
  }
  std::optional<Value> constant_beside_entries() const override {
    return f_.node().constant_beside_entries();
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto form = f_.node().linear_quadratic(n);
    if (!form) return std::nullopt;
    return linear_quadratic::tilt(*form, c_);
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto form = f_.node().graph(n, slope);
    if (!form) return std::nullopt;
    const GraphForm forms[] = {*form, graph_of(linear_atom(c_), n)};
    return convex::sum(forms);
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    // A program takes c as it is, without a rounded point.
    if (f_.facts().piecewise_quadratic && !is_diagonal_kind(W)) return std::nullopt;
    const auto from = [&](const Vector& point) {
      Prox part = f_.prox(point, W, look);
      if (part.x.size() == 0) return part;
      const double rounding = 2 * W.dual_norm(merged_.rest());
      return with_values(moved(part, part.x, part.v + c_, part.error_bound + rounding, z, W), part.values,
                         product(part.x, c_));
    };
    return reduced(z - W.solve(c_), z, W, from, [&](const Vector& r) { return W.solve(r); });
  }

 private:
  Function f_;
  MergedVector merged_;
  Vector c_;  ///< all of it
};

Function tilted(const Function& f, MergedVector c) {
  if (c.value().isZero(0) && f.dimension() != 0) return f;
  return Function(std::make_shared<Tilt>(f, std::move(c)));
}

}  // namespace

Function tilt(const Function& f, const Vector& c) {
  require_fit(f, c, "tilt", "c");
  if (const auto* inner = dynamic_cast<const Tilt*>(&f.node()))
    return tilted(inner->part(), inner->c().plus(c));
  return tilted(f, c);
}

}  // namespace convex::inline operations
