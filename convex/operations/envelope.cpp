#include <cmath>

#include "convex/composite/graph_algebra.hpp"
#include "convex/counted.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/operations.hpp"
#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"
#include "convex/operations/quadratic_term.hpp"
#include "convex/operations/supremum.hpp"
#include "convex/operations/takes_product.hpp"

namespace convex::inline operations {
namespace {

class Envelope : public Operation {
 public:
  Envelope(Function f, double gamma, std::optional<Metric> M)
      : f_(std::move(f)), gamma_(gamma), M_(std::move(M)) {}

  Index dimension() const override { return M_ ? M_->dimension() : f_.dimension(); }
  void require_size(Index n) const override { f_.node().require_size(n); }
  Facts facts() const override {
    const Facts f = f_.facts();
    return {.separable = f.separable && !M_,
            .piecewise_quadratic = f.piecewise_quadratic,
            .smooth = true,
            .finite = true};
  }
  /// In the plain norm, so that it means the same whatever the product of the space.
  Call call() const override {
    if (!M_) return {"envelope", {argument(f_.call()), argument("gamma", gamma_)}};
    const Call kernel{"quadratic", {argument("Q", Matrix(gram(*M_) / gamma_))}};
    Call plain{"inf_convolution", {argument(f_.call()), argument(kernel)}};
    const Call of_f = of_plain_product(f_.call(), M_->dimension());
    plain.unrounded = std::make_shared<const CallInProduct>(
        Call{"envelope", {argument(of_f), argument("gamma", gamma_)}}, *M_);
    return plain;
  }
  Value evaluate(const Vector& x) const override {
    const Smoothed split = smoothed(f_, kernel(x.size()), x);
    if (std::isfinite(split.value.value)) return split.value;
    // An envelope is finite: w was rounded out of the domain of f, or not found.
    const bool known = split.v.size() == x.size();
    return settled_value({infinity, infinity}, known ? std::optional(split.v) : std::nullopt, conjugate(), x);
  }
  std::optional<Vector> subgradient(const Vector& x) const override {
    return slope_of_smoothing(f_, kernel(x.size()), x);
  }
  Function conjugate() const override {
    const Function g = f_.conjugate();
    const Function square =
        M_ ? named("quadratic", {argument("Q", Matrix(gamma_ * gram(inverse(*M_))))}, M_->dimension())
           : named("squared_norm2", {argument("weight", gamma_)}, std::max<Index>(f_.dimension(), 1));
    const Function terms[] = {g, square};
    return proper_sum(terms);
  }
  /// The conjugate of f in W and gamma/2 ||y||_W².
  std::optional<Function> conjugate_in_product(const Metric& W) const override {
    if (!M_ || is_diagonal_kind(W) || gram(W) != gram(*M_)) return std::nullopt;
    const Function half_square = named("quadratic", {argument("Q", gram(W))}, W.dimension());
    const Function terms[] = {f_.conjugate(W), scale(half_square, gamma_)};
    return proper_sum(terms);
  }
  double recession(const Vector& d) const override { return f_.node().recession(d); }
  std::optional<Function> entry(Index i) const override {
    const auto f = M_ ? std::nullopt : f_.node().entry(i);
    return f ? std::optional(envelope(*f, gamma_)) : std::nullopt;
  }
  std::optional<Value> constant_beside_entries() const override {
    return M_ ? std::nullopt : f_.node().constant_beside_entries();
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    const auto form = f_.node().linear_quadratic(n);
    if (!form) return std::nullopt;
    return linear_quadratic::envelope(*form, gamma_, M_ ? *M_ : Metric::identity(n));
  }
  std::optional<GraphForm> graph(Index n, double slope) const override {
    const auto form = f_.node().graph(n, slope);
    if (!form) return std::nullopt;
    return convex::envelope(*form, M_ ? *M_ : Metric::identity(n), gamma_);
  }

 protected:
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look& look) const override {
    const Kernel q = kernel(z.size());
    const auto diagonal = [](const Metric& V) {
      return V.kind() == MetricKind::identity || V.kind() == MetricKind::diagonal;
    };
    if (facts().piecewise_quadratic && !(diagonal(W) && diagonal(q.Q)) && !ratio(W, q.Q)) return std::nullopt;
    return smoothed_prox(f_, q, z, W, look);
  }

 private:
  Kernel kernel(Index n) const { return {M_ ? *M_ : Metric::identity(n), gamma_, Vector::Zero(n), 0}; }

  Function f_;
  double gamma_;
  std::optional<Metric> M_;  // none: the plain one
};

class SquaredDistance : public Envelope {
 public:
  SquaredDistance(const Set& set, double weight)
      : Envelope(set.indicator, 1 / weight, std::nullopt), set_(set.call), weight_(weight) {}
  Call call() const override { return {"squared_distance", {argument(set_), argument("weight", weight_)}}; }

 private:
  Call set_;
  double weight_;
};

}  // namespace

Function envelope(const Function& f, double gamma) {
  require_positive(gamma, "envelope", "gamma");
  return Function(std::make_shared<Envelope>(f, gamma, std::nullopt));
}

Function envelope(const Function& f, double gamma, const Metric& M) {
  require_positive(gamma, "envelope", "gamma");
  if (f.dimension() != 0 && f.dimension() != M.dimension())
    throw InvalidInput("envelope: the metric has " + counted(M.dimension(), "row", "rows") +
                       ", the function takes " + counted(f.dimension(), "entry", "entries") +
                       "; give one of the other's size");
  if (M.kind() == MetricKind::identity) return envelope(f, gamma);
  return Function(std::make_shared<Envelope>(f, gamma, M));
}

Function squared_distance(const Set& set, double weight) {
  require_positive(weight, "squared_distance", "weight");
  return Function(std::make_shared<SquaredDistance>(set, weight));
}

}  // namespace convex::inline operations
