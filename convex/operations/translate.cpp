#include <cmath>

#include "convex/composite/graph_algebra.hpp"
#include "convex/double_double.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/merged_vector.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/two_function_max.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

class Translate : public Operation {
 public:
  Translate(Function f, MergedVector by) : f_(std::move(f)), merged_(std::move(by)), by_(merged_.value()) {}
  const Function& part() const { return f_; }
  const MergedVector& by() const { return merged_; }

  Index dimension() const override { return by_.size(); }
  Facts facts() const override {
    Facts facts = f_.facts();
    facts.cone = facts.support = facts.radial = facts.by_order = false;
    return facts;
  }
  Call call() const override {
    Call made = f_.call();
    for (const Vector& by : merged_.terms()) made = {"translate", {argument(made), argument("by", by)}};
    return made;
  }
  Value evaluate(const Vector& x) const override {
    const DoubleDoubleVector y = moved_back(DoubleDoubleVector(x));
    const Value near = value_near(f_, y, length_of(x) + length_of(by_));
    return near.value == infinity && y.lo.isZero(0) ? f_.evaluate(y.hi)
                                                    : near;  // y is x - b to the last digit
  }
  std::optional<Value> evaluate_pair(const DoubleDoubleVector& x) const override {
    return value_near(f_, moved_back(x), length_of(x.hi) + length_of(by_));
  }
  std::optional<Vector> subgradient(const Vector& x) const override { return f_.subgradient(x - by_); }
  double error_of_slope(double x, double w) const override {
    const DoubleDouble y = two_sum(x, -by_[0]);
    return f_.node().error_of_slope(y.hi, w) + error_of_moved_slope(f_.node(), y.hi, std::abs(y.lo), w);
  }
  Function conjugate() const override {
    Function made = f_.conjugate();
    for (const Vector& by : merged_.terms()) made = tilt(made, by);
    return made;
  }
  std::vector<Function> maximum_of() const override {
    std::vector<Function> parts = parts_of_max(f_);
    for (Function& part : parts) part = translate(part, by_);
    return parts;
  }
  double recession(const Vector& d) const override { return f_.node().recession(d); }
  double domain_support(const Vector& v) const override { return f_.node().domain_support(v) + v.dot(by_); }
  std::optional<Function> entry(Index i) const override {
    const auto f = f_.node().entry(i);
    return f ? std::optional(translate(*f, by_.segment(i, 1))) : std::nullopt;
  }
  std::optional<Value> constant_beside_entries() const override {
    return f_.node().constant_beside_entries();
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto form = f_.node().linear_quadratic(n);
    if (!form) return std::nullopt;
    return linear_quadratic::translate(*form, by_);
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto form = f_.node().graph(n, slope);
    if (!form) return std::nullopt;
    SparseMatrix identity(n, n);
    identity.setIdentity();
    return convex::precompose(*form, identity, -by_);
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    const Prox part = f_.prox(z - by_, W, look);
    if (part.x.size() == 0) return part;
    const double rounding =
        unit_roundoff * (W.norm(z - by_) + W.norm(part.x + by_)) + 2 * W.norm(merged_.rest());
    return with_values(moved(part, part.x + by_, part.v, part.error_bound + rounding, z, W), part.values, {},
                       product(part.v, by_));
  }

 private:
  /// x - b to twice the precision.
  DoubleDoubleVector moved_back(const DoubleDoubleVector& x) const {
    return difference(difference(x, by_), merged_.rest());
  }

  Function f_;
  MergedVector merged_;
  Vector by_;  ///< all of it
};

Function translated(const Function& f, MergedVector by) {
  if (by.value().isZero(0) && f.dimension() != 0) return f;
  return Function(std::make_shared<Translate>(f, std::move(by)));
}

}  // namespace

Function translate(const Function& f, const Vector& by) {
  require_fit(f, by, "translate", "by");
  if (const auto* inner = dynamic_cast<const Translate*>(&f.node()))
    return translated(inner->part(), inner->by().plus(by));
  return translated(f, by);
}

}  // namespace convex::inline operations
