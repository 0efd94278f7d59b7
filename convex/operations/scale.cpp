#include <cmath>

#include "convex/composite/graph_algebra.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/reduction.hpp"
#include "convex/operations/two_function_max.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

/// operation(f, number) as text, in one with the operation of that name that f is, where their numbers have
/// an exact product.
Call merged(const char* operation, const char* parameter, Call f, double number) {
  if (f.name == operation && f.arguments.size() == 2)
    if (const auto* inner = std::get_if<double>(&f.arguments[1].value)) {
      const double product = *inner * number;
      if (std::fma(*inner, number, -product) == 0 && std::isnormal(product)) {
        if (product == 1) return *std::get<std::shared_ptr<const Call>>(f.arguments[0].value);
        f.arguments[1] = argument(parameter, product);
        return f;
      }
    }
  return {operation, {argument(std::move(f)), argument(parameter, number)}};
}

/// f(x / rho)
Function dilated(const Function& f, DoubleDouble rho);

/// alpha f(x / rho): one node for both, as each conjugates into the other.
class Scale : public Operation {
 public:
  Scale(Function f, double alpha, DoubleDouble rho)
      : f_(std::move(f)), alpha_(alpha), rho_(rho.hi), whole_rho_(rho) {}
  const Function& part() const { return f_; }
  double alpha() const { return alpha_; }
  DoubleDouble rho() const { return whole_rho_; }

  Index dimension() const override { return f_.dimension(); }
  void require_size(Index n) const override { f_.node().require_size(n); }
  Facts facts() const override { return f_.facts(); }
  Call call() const override {
    Call made = f_.call();
    if (rho_ != 1) made = merged("dilate", "rho", std::move(made), rho_);
    if (alpha_ != 1) made = merged("scale", "alpha", std::move(made), alpha_);
    return made;
  }
  Value evaluate(const Vector& x) const override {
    if (rho_ == 1 && whole_rho_.lo == 0) return multiple_of(alpha_, f_.evaluate(x));
    return *evaluate_pair(DoubleDoubleVector(x));
  }
  std::optional<Value> evaluate_pair(const DoubleDoubleVector& x) const override {
    return multiple_of(alpha_, value_near(f_, quotient(x, whole_rho_), 0));
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    std::optional<Vector> v = f_.subgradient(x / rho_);
    if (v) *v *= alpha_ / rho_;
    return v;
  }
  double error_of_slope(double x, double w) const override {
    const double y = x / rho_, factor = std::abs(alpha_ / rho_), w_of_y = w * stiffness();
    const double left = std::abs(std::fma(-y, rho_, x) / rho_);
    return factor * (f_.node().error_of_slope(y, w_of_y) + error_of_moved_slope(f_.node(), y, left, w_of_y));
  }
  /// (alpha f(·/rho))* = alpha f*(· rho/alpha).
  Function conjugate() const override {
    return scale(dilated(f_.conjugate(), convex::quotient({alpha_, 0}, whole_rho_)), alpha_);
  }
  std::vector<Function> maximum_of() const override {
    std::vector<Function> parts = parts_of_max(f_);
    for (Function& part : parts) part = scale(dilate(part, rho_), alpha_);
    return parts;
  }
  double recession(const Vector& d) const override { return alpha_ * f_.node().recession(d / rho_); }
  double domain_support(const Vector& v) const override { return f_.node().domain_support(rho_ * v); }
  std::optional<Function> entry(Index i) const override {
    const auto f = f_.node().entry(i);
    return f ? std::optional(scale(dilate(*f, rho_), alpha_)) : std::nullopt;
  }
  std::optional<Value> constant_beside_entries() const override {
    const auto of_f = f_.node().constant_beside_entries();
    return of_f ? std::optional(multiple_of(alpha_, *of_f)) : std::nullopt;
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto form = f_.node().linear_quadratic(n);
    if (!form) return std::nullopt;
    return linear_quadratic::scale(linear_quadratic::dilate(*form, rho_), alpha_);
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const double of_part =
        slope > 0 ? unit_of_slope(slope * std::abs(rho_) / alpha_) : -unit_of_slope(-slope / std::abs(rho_));
    const auto form = f_.node().graph(n, of_part);
    if (!form) return std::nullopt;
    SparseMatrix shrink(n, n);
    shrink.setIdentity();
    return convex::scale(convex::precompose(*form, shrink / rho_, Vector::Zero(n)), alpha_);
  }

 protected:
  /// x = rho s: ½||x - z||_W² + alpha f(x/rho) is alpha times ½||s - z/rho||² in rho² W / alpha, plus f(s).
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    const Metric V = times(stiffness(), W);
    const auto from = [&](const Vector& point) {
      Prox part = f_.prox(point, V, look);
      if (part.x.size() == 0) return part;
      part.duality_gap *= alpha_;
      if (part.values)
        part.values = {multiple_of(alpha_, part.values->f_x), multiple_of(alpha_, part.values->f_v),
                       part.values->miss};
      const Vector x = rho_ * part.x;
      // s = x/rho is the prox of f in rho²W/alpha at z/rho, where rho is off by lo.
      const double of_rho = 4 * std::abs(whole_rho_.lo / rho_) * (W.norm(z) + W.norm(x));
      return with_values(
          moved(part, x, (alpha_ / rho_) * part.v, std::sqrt(alpha_) * part.error_bound + of_rho, z, W),
          part.values);
    };
    return reduced(z / rho_, z, W, from, [&](const Vector& r) -> Vector { return W.solve(r) / rho_; });
  }

 private:
  /// rho²/alpha, where rho² alone may be no double.
  double stiffness() const {
    const double square = rho_ * rho_;
    return std::isnormal(square) ? square / alpha_ : rho_ / alpha_ * rho_;
  }

  Function f_;
  double alpha_;
  double rho_;
  DoubleDouble whole_rho_;  ///< to twice the precision: rho/alpha is no double, nor are products
};

Function scaled(const Function& f, double alpha, DoubleDouble rho) {
  const Facts facts = f.facts();
  if (facts.indicator) alpha = 1;
  if (facts.support && rho.hi > 0) {  // positively homogeneous
    alpha = convex::quotient({alpha, 0}, rho).value();
    rho = {1, 0};
    if (facts.indicator) alpha = 1;
  }
  if (!(alpha > 0) || !std::isfinite(alpha) || !std::isfinite(rho.hi) || rho.hi == 0)
    throw InvalidInput(
        "scale: the factors of nested operations leave the range of doubles; give milder ones");
  if (!std::isfinite(rho.lo)) rho.lo = 0;
  if (alpha == 1 && rho.hi == 1 && rho.lo == 0) return f;
  return Function(std::make_shared<Scale>(f, alpha, rho));
}

}  // namespace

namespace {

Function dilated(const Function& f, DoubleDouble rho) {
  if (const auto* inner = dynamic_cast<const Scale*>(&f.node()))
    return scaled(inner->part(), inner->alpha(), product_of_pairs(rho, inner->rho()));
  return scaled(f, 1, rho);
}

}  // namespace

Function scale(const Function& f, double alpha) {
  require_positive(alpha, "scale", "alpha");
  if (const auto* inner = dynamic_cast<const Scale*>(&f.node()))
    return scaled(inner->part(), alpha * inner->alpha(), inner->rho());
  return scaled(f, alpha, {1, 0});
}

Function dilate(const Function& f, double rho) {
  if (rho == 0 || !std::isfinite(rho))
    throw InvalidInput("dilate(rho): zero or not finite; give a finite number that is not 0");
  return dilated(f, {rho, 0});
}

}  // namespace convex::inline operations
