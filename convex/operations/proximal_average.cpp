#include <algorithm>
#include <cmath>

#include "convex/composite/composite_prox.hpp"
#include "convex/composite/graph_algebra.hpp"
#include "convex/counted.hpp"
#include "convex/linear_algebra/cholesky.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/linear_quadratic/value.hpp"
#include "convex/operations/average_by_proxes.hpp"
#include "convex/operations/composed_prox.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/supremum.hpp"
#include "convex/operations/takes_product.hpp"

namespace convex::inline operations {
namespace {

class ProximalAverage : public Operation {
 public:
  ProximalAverage(Function f, Function g, double t, double gamma, std::optional<Metric> M)
      : f_(std::move(f)), g_(std::move(g)), t_(t), gamma_(gamma), M_(std::move(M)) {
    n_ = M_ ? M_->dimension() : common_dimension(std::vector{f_, g_}, "proximal_average");
  }

  Index dimension() const override { return n_; }
  void require_size(Index n) const override {
    f_.node().require_size(n);
    g_.node().require_size(n);
  }
  Facts facts() const override {
    const Facts f = f_.facts(), g = g_.facts();
    return {.separable = f.separable && g.separable && !M_,
            .piecewise_quadratic = f.piecewise_quadratic && g.piecewise_quadratic,
            .smooth = f.finite && g.finite && (f.smooth || g.smooth),
            .finite = f.finite && g.finite};
  }
  /// In the plain product whatever that of the space, by x = F⁻ᵀ(Fᵀx), M = F Fᵀ: nested in `precompose` it is
  /// plain.
  Call call() const override {
    const auto of_parts = [&](Call f, Call g) {
      return Call{"proximal_average",
                  {argument(std::move(f)), argument(std::move(g)), argument("weight", t_),
                   argument("gamma", gamma_)}};
    };
    if (!M_) return of_parts(f_.call(), g_.call());
    const linear_algebra::Cholesky factor(gram(*M_));
    Matrix back = Matrix::Identity(n_, n_);
    factor.solve_upper_in_place(back);
    const auto inside = [&](const Function& f) {
      return Call{"precompose", {argument(f.call()), argument("A", back)}};
    };
    const Call average = of_parts(inside(f_), inside(g_));
    Call plain{"precompose", {argument(average), argument("A", Matrix(factor.L().transpose()))}};
    plain.unrounded = std::make_shared<const CallInProduct>(
        of_parts(of_plain_product(f_.call(), n_), of_plain_product(g_.call(), n_)), *M_);
    return plain;
  }
  Value evaluate(const Vector& x) const override {
    if (const auto sum = value_by_entries(*this, x)) return *sum;
    const AverageOf average = at_metric(x.size());
    if (const auto at_end = average_at_end_of_domain(average, x)) return *at_end;
    const auto by_proxes = facts().piecewise_quadratic ? std::nullopt : average_by_proxes(average, x);
    if (by_proxes && is_of_rounding(by_proxes->value)) return by_proxes->value;
    ByProgram found = by_program(x);
    if (found.least.size() >= x.size() && !is_of_rounding(found.value))
      found.value = between_points(found.value,
                                   average_with_second(average, found.least.head(x.size()), x, found.slope),
                                   found.slope, conjugate(), x);
    if (by_proxes && by_proxes->value.error < found.value.error) found = {by_proxes->value, by_proxes->v};
    return settled_value(found.value, found.slope, conjugate(), x);
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (!facts().piecewise_quadratic)
      if (const auto by_proxes = average_by_proxes(at_metric(x.size()), x);
          by_proxes && is_of_rounding(by_proxes->value))
        return by_proxes->v;
    if (auto slope = maximiser(conjugate(), x)) return slope;
    return Operation::subgradient(x);
  }
  Function conjugate() const override {
    if (!M_) return proximal_average(f_.conjugate(), g_.conjugate(), t_, 1 / gamma_);
    return proximal_average(f_.conjugate(), g_.conjugate(), t_, 1 / gamma_, inverse(*M_));
  }
  /// The average of the conjugates in W. Of piecewise linear-quadratic ones fractions know the conjugate of
  /// this function, and 1/gamma would be rounded in it.
  std::optional<Function> conjugate_in_product(const Metric& W) const override {
    if (!M_ || facts().piecewise_quadratic || is_diagonal_kind(W) || gram(W) != gram(*M_))
      return std::nullopt;
    return proximal_average(f_.conjugate(W), g_.conjugate(W), t_, 1 / gamma_, W);
  }
  /// The square keeps p and q together.
  double recession(const Vector& d) const override {
    return t_ * f_.node().recession(d) + (1 - t_) * g_.node().recession(d);
  }
  double domain_support(const Vector& v) const override {
    return t_ * f_.node().domain_support(v) + (1 - t_) * g_.node().domain_support(v);
  }
  std::optional<Function> entry(Index i) const override {
    const auto f = M_ ? std::nullopt : f_.node().entry(i), g = M_ ? std::nullopt : g_.node().entry(i);
    if (!f || !g) return std::nullopt;
    return convex::proximal_average(*f, *g, t_, gamma_);
  }
  std::optional<Value> constant_beside_entries() const override {
    const auto f = f_.node().constant_beside_entries(), g = g_.node().constant_beside_entries();
    if (M_ || !f || !g) return std::nullopt;
    return sum_of(multiple_of(t_, *f), multiple_of(1 - t_, *g));
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto forms = programs(std::vector{f_, g_}, n);
    if (!forms) return std::nullopt;
    return linear_quadratic::proximal_average((*forms)[0], (*forms)[1], t_, gamma_, product(n));
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto f = f_.node().graph(n, slope), g = g_.node().graph(n, slope);
    if (!f || !g) return std::nullopt;
    return convex::proximal_average(*f, *g, t_, gamma_, product(n));
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    // gamma W = factor M, factor 1: the prox of the average is the average of the proxes.
    const auto factor = ratio(W, product(z.size()));
    const double distance = factor ? std::abs(*factor * gamma_ - 1) : 1;
    if (!(distance <= equal_steps)) return std::nullopt;
    const Prox p = f_.prox(z, W, look), q = g_.prox(z, W, look);
    if (p.x.size() == 0) return p;
    if (q.x.size() == 0) return q;
    Prox part = p;
    part.route = std::max(p.route, q.route);
    part.by_conjugate = p.by_conjugate || q.by_conjugate;
    if (p.status == Status::solved) part.status = q.status;
    if (p.method != q.method) part.method += ", " + q.method;
    part.method = "mean of proxes, " + part.method;
    Prox whole = moved(part, t_ * p.x + (1 - t_) * q.x, t_ * p.v + (1 - t_) * q.v,
                       t_ * p.error_bound + (1 - t_) * q.error_bound, z, W);
    whole.duality_gap = t_ * p.duality_gap + (1 - t_) * q.duality_gap;
    whole.values = values(p, q);
    return whole;
  }

 private:
  /// The metrics W and M/gamma are one when they differ by the rounding of 1/gamma.
  static constexpr double equal_steps = 4 * unit_roundoff;
  Metric product(Index n) const { return M_ ? *M_ : Metric::identity(n); }
  AverageOf at_metric(Index n) const { return {f_, g_, t_, gamma_, product(n)}; }

  /// t f(p) + (1-t) g(q) + t(1-t)/(2 gamma) ||p - q||², and the same of the conjugates at the two covectors.
  std::optional<PairOfValues> values(const Prox& p, const Prox& q) const {
    const auto of_part = [](const Function& f, const Prox& at) -> PairOfValues {
      if (at.values) return *at.values;
      return {f.evaluate(at.x), f.conjugate().evaluate(at.v), 0};
    };
    const auto mean = [&](const Value& a, const Value& b, const Value& square) {
      return sum_of(sum_of(multiple_of(t_, a), multiple_of(1 - t_, b)),
                    multiple_of(t_ * (1 - t_) / 2, square));
    };
    const Metric M = product(p.x.size());
    const Vector apart = p.x - q.x, turned = p.v - q.v;
    const PairOfValues a = of_part(f_, p), b = of_part(g_, q);
    return PairOfValues{
        mean(a.f_x, b.f_x, multiple_of(1 / gamma_, convex::product(apart, M.multiply(apart)))),
        mean(a.f_v, b.f_v, multiple_of(gamma_, convex::product(turned, M.solve(turned)))),
        std::max(a.miss, b.miss)};
  }

  Function f_, g_;
  double t_, gamma_;
  std::optional<Metric> M_;  // none: the plain one
  Index n_ = 0;
};

Function average(const Function& f, const Function& g, double t, double gamma, std::optional<Metric> M) {
  if (!(t > 0 && t < 1))
    throw InvalidInput("proximal_average(weight): not between 0 and 1; give a weight inside (0, 1)");
  require_positive(gamma, "proximal_average", "gamma");
  for (const Function& part : {f, g})
    if (M && part.dimension() != 0 && part.dimension() != M->dimension())
      throw InvalidInput("proximal_average: a function takes " +
                         counted(part.dimension(), "entry", "entries") + ", the metric has " +
                         counted(M->dimension(), "row", "rows") + "; give one of the other's size");
  return Function(std::make_shared<ProximalAverage>(f, g, t, gamma, std::move(M)));
}

}  // namespace

Function proximal_average(const Function& f, const Function& g, double t, double gamma) {
  return average(f, g, t, gamma, std::nullopt);
}

Function proximal_average(const Function& f, const Function& g, double t, double gamma, const Metric& M) {
  if (M.kind() == MetricKind::identity) return average(f, g, t, gamma, std::nullopt);
  return average(f, g, t, gamma, M);
}

}  // namespace convex::inline operations
