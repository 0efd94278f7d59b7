#include "convex/functions/convex_set.hpp"

#include <cmath>

#include "convex/infinity.hpp"
#include "convex/linear_quadratic/operations.hpp"

namespace convex::inline named_functions {
namespace {

/// What s in S and u, normal there, miss of that, in the metric d of u. From s', u' that miss nothing the
/// bound of a pair is ||D(z - u') - s'||; the way there and back is 2 (||s - s'|| + ||u - u'||).
double miss(const ConvexSet& S, const Vector& s, const Vector& u, const Vector& d) {
  if (S.split_route() == SplitRoute::two_formulas) return 0;
  Vector point = s, normal = u;
  S.make_conjugate(point, normal);
  const Vector root = d.cwiseSqrt();
  return 2 * ((point - s).cwiseQuotient(root).norm() + (normal - u).cwiseProduct(root).norm());
}

class SetIndicator : public Atom {
 public:
  explicit SetIndicator(std::shared_ptr<const ConvexSet> S) : S_(std::move(S)) {}
  Index dimension() const override { return S_->dimension(); }
  void require_size(Index n) const override { S_->require_size(n, S_->call().name); }
  bool takes_any_diagonal() const override { return S_->takes_any_diagonal(); }
  Facts facts() const override {
    Facts facts = S_->facts();
    facts.indicator = true;
    facts.support = facts.cone;
    return facts;
  }
  Call call() const override { return {"indicator", {argument(S_->call())}}; }
  double value(const Vector& x) const override { return evaluate(x).value; }
  Value evaluate(const Vector& x) const override { return S_->membership(x); }
  Function conjugate() const override { return support_of(S_); }
  double domain_size() const override { return S_->scale(); }
  std::optional<Vector> subgradient(const Vector& x) const override {
    if (!S_->contains(x)) return std::nullopt;
    return Vector::Zero(x.size());
  }
  double recession(const Vector& d) const override { return d.isZero(0) || S_->recedes(d) ? 0 : infinity; }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override { return S_->project(z, d); }
  Index decomposed_size(Index n) const override { return S_->decomposed_size(n); }
  bool prox_by_conjugate() const override {
    return S_->split_route() == SplitRoute::projection_from_support_prox;
  }
  double subgradient_miss(const Vector& x, const Vector& v, const Vector& d) const override {
    return miss(*S_, x, v, d.cwiseInverse());
  }
  /// By the formula for the prox of the support function, which by Moreau's identity is D(z - x).
  std::optional<Vector> prox_covector(const Vector&, const Vector& z, const Vector& d) const override {
    return S_->support_prox(d.cwiseProduct(z), d.cwiseInverse());
  }
  std::optional<Prox> prox_general(const Vector& z, const Metric& W) const override {
    return S_->project_general(z, W);
  }
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    return S_->project_jacobian(z, d);
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override { return S_->indicator_form(n); }

 private:
  std::shared_ptr<const ConvexSet> S_;
};

class SetSupport : public Atom {
 public:
  explicit SetSupport(std::shared_ptr<const ConvexSet> S) : S_(std::move(S)) {}
  Index dimension() const override { return S_->dimension(); }
  void require_size(Index n) const override { S_->require_size(n, S_->support_call().name); }
  bool takes_any_diagonal() const override { return S_->takes_any_diagonal(); }
  Facts facts() const override {
    const Facts of_set = S_->facts();
    return {.indicator = of_set.cone,
            .cone = of_set.cone,
            .support = true,
            .separable = of_set.separable,
            .piecewise_quadratic = of_set.piecewise_quadratic,
            .finite = S_->bounded(),
            .radial = of_set.radial,
            .by_order = S_->is_base_polytope()};
  }
  Call call() const override { return S_->support_call(); }
  double value(const Vector& x) const override { return S_->support(x); }
  Value evaluate(const Vector& x) const override { return S_->support_value(x); }
  Function conjugate() const override { return indicator_of(S_); }
  std::optional<Vector> subgradient(const Vector& x) const override { return S_->maximiser(x); }
  /// The domain's closure is the polar of the directions in which S has no end.
  double domain_support(const Vector& v) const override {
    return v.isZero(0) || S_->recedes(v) ? 0 : infinity;
  }
  Vector prox_diagonal(const Vector& z, const Vector& d) const override { return S_->support_prox(z, d); }
  Index decomposed_size(Index n) const override { return S_->decomposed_size(n); }
  bool prox_by_conjugate() const override {
    return S_->split_route() == SplitRoute::support_prox_from_projection;
  }
  double subgradient_miss(const Vector& x, const Vector& v, const Vector& d) const override {
    return miss(*S_, v, x, d);
  }
  /// v is in S, and x in the normal cone at v.
  std::optional<Vector> prox_covector(const Vector&, const Vector& z, const Vector& d) const override {
    return S_->project(d.cwiseProduct(z), d.cwiseInverse());
  }
  /// The derivative of z - D⁻¹ project(Dz, D⁻¹).
  Jacobian prox_jacobian(const Vector& z, const Vector& d) const override {
    return S_->project_jacobian(d.cwiseProduct(z), d.cwiseInverse()).of_conjugate(d);
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override { return S_->support_form(n); }

 private:
  std::shared_ptr<const ConvexSet> S_;
};

class ConeSet : public ConvexSet {
 public:
  explicit ConeSet(Cone K) : K_(std::move(K)) {}
  Index dimension() const override { return K_.dimension; }
  void require_size(Index n, const std::string& name) const override {
    if (K_.require_size) K_.require_size(n, name);
  }
  Call call() const override { return K_.call; }
  Call support_call() const override { return K_.polar_call; }
  Facts facts() const override {
    return {.indicator = true, .cone = true, .support = true, .piecewise_quadratic = K_.form != nullptr};
  }
  bool bounded() const override { return false; }
  bool takes_any_diagonal() const override { return K_.any_diagonal; }
  Vector project(const Vector& z, const Vector& d) const override { return K_.project(z, d); }
  Jacobian project_jacobian(const Vector& z, const Vector& d) const override { return K_.jacobian(z, d); }
  double support(const Vector& v) const override { return support_value(v).value; }
  Value support_value(const Vector& v) const override {
    return indicated(project(v, Vector::Ones(v.size())).stableNorm(), v.stableNorm());
  }
  std::optional<Vector> maximiser(const Vector& v) const override {
    if (support(v) > 0) return std::nullopt;
    return Vector::Zero(v.size());
  }
  Vector support_prox(const Vector& z, const Vector& d) const override { return K_.project_polar(z, d); }
  Index decomposed_size(Index n) const override {
    return K_.of_eigenvalues ? 2 * static_cast<Index>(std::lround(std::sqrt(static_cast<double>(n)))) : 0;
  }
  SplitRoute split_route() const override { return K_.route; }
  void make_conjugate(Vector& s, Vector& u) const override {
    if (K_.make_conjugate) K_.make_conjugate(s, u);
  }
  std::optional<LinearQuadratic> indicator_form(Index n) const override {
    if (!K_.form) return std::nullopt;
    return K_.form(n);
  }

 private:
  Cone K_;
};

}  // namespace

Call ConvexSet::support_call() const { return {"support", {argument(call())}}; }

Value ConvexSet::membership(const Vector& x) const {
  const double miss = (x - project(x, Vector::Ones(x.size()))).stableNorm();
  return indicated(miss, x.stableNorm() + scale());
}

Value ConvexSet::support_value(const Vector& v) const {
  const double found = support(v);
  return sum_of_terms(found, std::abs(found));
}

std::optional<LinearQuadratic> ConvexSet::indicator_form(Index) const { return std::nullopt; }

std::optional<LinearQuadratic> ConvexSet::support_form(Index n) const {
  if (const std::optional<LinearQuadratic> form = indicator_form(n))
    return linear_quadratic::conjugate(*form);
  return std::nullopt;
}

Function indicator_of(std::shared_ptr<const ConvexSet> S) {
  return Function(std::make_shared<SetIndicator>(std::move(S)));
}

Function support_of(std::shared_ptr<const ConvexSet> S) {
  return Function(std::make_shared<SetSupport>(std::move(S)));
}

Set set_of(std::shared_ptr<const ConvexSet> S) {
  Call call = S->call();
  return {indicator_of(std::move(S)), std::move(call)};
}

Set set_of(Cone K) { return set_of(std::make_shared<ConeSet>(std::move(K))); }

}  // namespace convex::inline named_functions
