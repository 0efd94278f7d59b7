#include <algorithm>
#include <cmath>

#include "convex/composite/graph_algebra.hpp"
#include "convex/counted.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/exact_end.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/reduction.hpp"
#include "convex/operations/takes_product.hpp"
#include "convex/operations/value_near.hpp"

namespace convex::inline operations {
namespace {

/// x -> h(Mx), M definite: one to one, and metrics stay what they are. f: of which it is the conjugate in the
/// product of M, where that is known; h may have been rounded.
class InProduct : public Operation {
 public:
  InProduct(Function h, Metric M, std::optional<Function> f)
      : h_(std::move(h)), M_(std::move(M)), f_(std::move(f)) {}
  const Function& part() const { return h_; }
  const Metric& map() const { return M_; }

  Index dimension() const override { return M_.dimension(); }
  Facts facts() const override {
    Facts facts = h_.facts();
    facts.separable = facts.separable && is_diagonal_kind(M_);
    return facts;
  }
  Call call() const override {
    Call plain{"precompose", {argument(h_.call()), argument("A", gram(M_))}};
    if (f_)
      plain.unrounded = std::make_shared<const CallInProduct>(
          Call{"conjugate", {argument(of_plain_product(f_->call(), dimension()))}}, M_);
    return plain;
  }
  /// Of a conjugate that has been rounded, as a product's inverse is, the map may take each rounding for
  /// condition(M) of it: fractions know f itself.
  Value evaluate(const Vector& x) const override {
    if (f_ && !is_diagonal_kind(M_) && facts().piecewise_quadratic)
      if (const auto exact = exact_value_at(self(), x)) return *exact;
    return value_near(h_, image(x).value, length_of(gram(M_).cwiseAbs() * x.cwiseAbs()));
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    const std::optional<Vector> v = h_.subgradient(image(x).value);
    if (!v) return std::nullopt;
    return image(*v).value;
  }
  double error_of_slope(double x, double w) const override {
    const double m = M_.diagonal()[0], y = m * x, left = std::abs(std::fma(m, x, -y)), w_of_y = w / (m * m);
    return m * (h_.node().error_of_slope(y, w_of_y) + error_of_moved_slope(h_.node(), y, left, w_of_y));
  }
  Function conjugate() const override;
  double recession(const Vector& d) const override { return h_.node().recession(image(d).value); }
  double domain_support(const Vector& v) const override {
    return h_.node().domain_support(preimage(v).value);
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto form = h_.node().linear_quadratic(n);
    if (!form) return std::nullopt;
    return linear_quadratic::precompose(*form, gram(M_).sparseView(), Vector::Zero(n));
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto form = h_.node().graph(n, slope);
    if (!form) return std::nullopt;
    return convex::precompose(*form, gram(M_).sparseView(), Vector::Zero(n));
  }

  /// In a full metric not by a program over Mx, which takes a u that misses Mx by rounding for it: it may be
  /// far from that in a metric that is nearly singular.
  Prox prox(const Vector& z, const Metric& W, const Look& look) const override {
    const auto found = is_diagonal_kind(W) ? std::nullopt : reduced_prox(z, W, look);
    return found ? *found : Operation::prox(z, W, look);
  }

 protected:
  /// With u = Mx the metric is M⁻¹WM⁻¹, the inverse of C = M W⁻¹M. As matrices both are rounded; the
  /// residual sees W and M as given, and corrects the point Mz by it.
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    const auto factor = ratio(M_, W);
    const Metric C = factor ? times(*factor, M_) : congruence(M_, W);
    const auto into_point = [&](const Vector& covector) -> Vector {  // M W⁻¹ covector
      return factor ? Vector(*factor * covector) : image(refined_solve(W, covector)).value;
    };
    // Moreau's identity leads back to C, and to points C⁻¹u.
    const auto by_conjugate_of_h = [&](const Function& f) {
      const auto from = [&](const Vector& point) {
        Prox part = f.prox(point, C, look);
        if (part.x.size() == 0) return part;
        part.by_conjugate = true;
        const auto values = part.values;  // those of f, of which h is the conjugate
        Prox whole = mapped(part, part.v, part.x, z, W);
        if (values) whole.values = turned_round(*values);
        return whole;
      };
      const Vector covector =
          factor ? Vector(z / *factor) : preimage(metric_difference(W, z, Vector::Zero(z.size()))).value;
      return reduced(covector, z, W, from, [&](const Vector& r) { return C.solve(into_point(r)); });
    };
    if (const auto f = primal_of(h_)) return by_conjugate_of_h(*f);
    const Metric S = inverse(C);
    if (facts().piecewise_quadratic && !factor && !is_diagonal_kind(S)) return std::nullopt;
    const auto from = [&](const Vector& point) {
      Prox part = h_.prox(point, S, look);
      if (part.x.size() == 0) return part;
      return with_values(mapped(part, part.x, part.v, z, W), part.values);
    };
    Prox found = reduced(image(z).value, z, W, from, into_point);
    // S is rounded, and C is not where M and W are one.
    if (f_ && factor && !is_diagonal_kind(W) && !is_settled(found, z, W))
      if (Prox other = by_conjugate_of_h(*f_); other.x.size() > 0 && other.error_bound < found.error_bound)
        return other;
    return found;
  }

  /// Mx and M⁻¹u, each rounded once or nearly so, and what it is off by.
  struct Rounded {
    Vector value, off;
  };
  virtual Rounded image(const Vector& x) const { return product_of(M_, x); }
  virtual Rounded preimage(const Vector& u) const { return quotient_of(M_, u); }
  static Rounded product_of(const Metric& M, const Vector& x) {
    const Vector value = metric_difference(M, x, Vector::Zero(x.size()));
    return {value, excess_of_image(M, x, value)};
  }
  static Rounded quotient_of(const Metric& M, const Vector& u) {
    const Vector value = refined_solve(M, u);
    return {value, M.solve(excess_of_image(M, value, u))};
  }

 private:
  /// The pair x = M⁻¹u, v = Mp of a part's point u and covector p, as doubles hold it. What x and v are
  /// roundings of is a pair of the whole, and they themselves are none: in a metric that is nearly singular
  /// ||x - M⁻¹u||_W, which moves the point and its residual, and ||v - Mp||_(W⁻¹) may be far above it.
  Prox mapped(const Prox& part, const Vector& u, const Vector& p, const Vector& z, const Metric& W) const {
    const Rounded x = preimage(u), v = image(p);
    Prox whole = moved(part, x.value, v.value, part.error_bound, z, W);
    const double off = 2 * W.norm(x.off) + W.dual_norm(v.off);
    whole.error_bound += std::max(0.0, off - rounding_of_a_move(z, x.value, v.value, W));
    return whole;
  }

  Function h_;
  Metric M_;
  std::optional<Function> f_;
};

/// The conjugate h*(M⁻¹·) of h(M·), which it keeps. A map that undoes M⁻¹ is then left out together with it:
/// taken one after the other, as rounded, the two leave condition(M) roundings in the point, and in the
/// membership tolerance, which is relative to the terms of each. Points are mapped by M itself: its inverse
/// is rounded, and another map.
class ConjugateInProduct : public InProduct {
 public:
  ConjugateInProduct(const Function& primal, const InProduct& of)
      : InProduct(of.part().conjugate(), inverse(of.map()), std::nullopt),
        primal_(primal),
        undone_by_(of.map()) {}
  Function conjugate() const override { return primal_; }
  Call call() const override {
    Call plain = InProduct::call();
    plain.unrounded = std::make_shared<const CallInProduct>(Call{"conjugate", {argument(primal_.call())}},
                                                            Metric::identity(dimension()));
    return plain;
  }
  /// The factor with M⁻¹V = factor, when there is one.
  std::optional<double> product(const Metric& V) const { return ratio(V, undone_by_); }

 protected:
  Rounded image(const Vector& x) const override { return quotient_of(undone_by_, x); }
  Rounded preimage(const Vector& u) const override { return product_of(undone_by_, u); }

 private:
  Function primal_;
  Metric undone_by_;
};

Function InProduct::conjugate() const {
  return Function(std::make_shared<ConjugateInProduct>(self(), *this));
}

Function in_product(const Function& h, const Metric& M, const std::optional<Function>& f) {
  if (h.dimension() != 0 && h.dimension() != M.dimension())
    throw InvalidInput("conjugate: the metric has " + counted(M.dimension(), "row", "rows") +
                       ", the function takes " + counted(h.dimension(), "entry", "entries") +
                       "; give one of the other's size");
  if (M.kind() == MetricKind::identity) return h;
  if (const auto* inner = dynamic_cast<const ConjugateInProduct*>(&h.node()))
    if (const auto factor = inner->product(M))
      return in_product(inner->part(), times(*factor, Metric::identity(M.dimension())), std::nullopt);
  return Function(std::make_shared<InProduct>(h, M, f));
}

}  // namespace

Function in_product(const Function& h, const Metric& M) { return in_product(h, M, std::nullopt); }

}  // namespace convex::inline operations

// Of `Function`, here: without a rule of an operation's own it is an operation on the conjugate.
convex::Function convex::Function::conjugate(const Metric& M) const {
  if (const auto* operation = dynamic_cast<const Operation*>(&node()))
    if (auto g = operation->conjugate_in_product(M)) return *std::move(g);
  return in_product(conjugate(), M, *this);
}
