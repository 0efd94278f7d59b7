#include <algorithm>
#include <cmath>

#include "convex/composite/graph_algebra.hpp"
#include "convex/functions/interior.hpp"
#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/operations/operation.hpp"
#include "convex/operations/operations.hpp"

namespace convex::inline operations {
namespace {

class Distance : public Operation {
 public:
  Distance(Set set, double weight) : set_(std::move(set)), weight_(weight) {}

  Index dimension() const override { return set_.indicator.dimension(); }
  void require_size(Index n) const override { set_.indicator.node().require_size(n); }
  Facts facts() const override {
    return {.support = set_.indicator.facts().cone,
            .separable = dimension() == 1,
            .piecewise_quadratic = dimension() == 1 && set_.indicator.facts().piecewise_quadratic,
            .finite = true};
  }
  Call call() const override { return {"distance", {argument(set_.call), argument("weight", weight_)}}; }
  Value evaluate(const Vector& x) const override {
    const Prox part = nearest(x);
    if (part.x == x && is_well_inside(set_.indicator, x, x.norm() + size_of_set(x.size()))) return {0, 0};
    return {weight_ * (x - part.x).norm(), weight_ * (part.error_bound + 4 * unit_roundoff * x.norm())};
  }
  std::optional<Vector> subgradient(const Vector& x) const override { return slope(x - nearest(x).x, x); }
  /// The norm and the set convolve: the conjugate is the support function of the set on the dual ball.
  Function conjugate() const override {
    const Function terms[] = {set_.indicator.conjugate(), ball()};
    return proper_sum(terms);
  }
  double recession(const Vector& d) const override {
    return set_.indicator.node().recession(d) <= 0 ? 0 : weight_ * d.norm();
  }
  std::optional<LinearQuadratic> linear_quadratic(Index n) const override {
    if (!facts().piecewise_quadratic) return std::nullopt;
    return inf_convolution(named("norm1", {argument("weight", weight_)}, n), set_.indicator)
        .node()
        .linear_quadratic(n);
  }
  std::optional<GraphForm> graph(Index n, double) const override {
    const auto norm = named("norm2", {argument("weight", weight_)}, n).node().graph(n);
    const auto set = set_.indicator.node().graph(n);
    if (!norm || !set) return std::nullopt;
    return convex::inf_convolution(*set, *norm);
  }

 protected:
  /// In the metric k I the point goes weight/k towards the set, and stops there (Beck 2017, Lemma 6.43).
  std::optional<Prox> reduced_prox(const Vector& z, const Metric& W, const Look&) const override {
    const bool diagonal = W.kind() == MetricKind::identity || W.kind() == MetricKind::diagonal;
    const double k = W.diagonal()[0];
    if (!diagonal || !(W.diagonal().array() == k).all()) return std::nullopt;
    const Prox part = nearest(z);
    if (part.x.size() == 0) return part;
    const Vector away = z - part.x;
    const double reach = weight_ / k, length = away.norm();
    const bool inside = length <= reach;
    const Vector v = inside ? Vector(k * away) : Vector((weight_ / length) * away);
    Prox whole = moved(part, inside ? part.x : Vector(z - v / k), v, std::sqrt(k) * part.error_bound, z, W);
    if (!part.values) return whole;
    // The set's support function, there weight times a unit normal or less, is the conjugate.
    const double factor = inside ? k : weight_ / length, error = 4 * unit_roundoff * weight_ * z.norm();
    whole.duality_gap *= factor;
    whole.values = {inside ? Value{0, 0} : Value{weight_ * (whole.x - part.x).norm(), error},
                    multiple_of(factor, part.values->f_v), part.values->miss};
    return whole;
  }

 private:
  /// A point of the set is its own nearest, up to what may be taken for a point of it, where the search for
  /// one knows less.
  Prox nearest(const Vector& x) const {
    Prox found = set_.indicator.prox(x, Metric::identity(x.size()));
    // The set's size may take programs.
    if (found.error_bound <= accuracy_of_prox * x.norm()) return found;
    const double membership = accuracy_of_prox * (x.norm() + size_of_set(x.size()));
    if (found.error_bound <= membership) return found;
    const Value inside = set_.indicator.evaluate(x);
    if (inside.value != 0 || inside.error != 0) return found;
    Prox own;
    own.x = x;
    own.v = Vector::Zero(x.size());
    own.error_bound = membership;
    own.route = ProxRoute::iterative;
    own.method = "a point of the set";
    own.values.emplace();
    return own;
  }
  /// Of the numbers that bound it, as far as they are known.
  double size_of_set(Index n) const {
    const auto* atom = dynamic_cast<const Atom*>(&set_.indicator.node());
    double size = atom ? atom->domain_size() : 0;
    for (Index i = 0; i < n && !atom; ++i)
      for (const double side : {1.0, -1.0}) {
        const double end = set_.indicator.node().domain_support(side * Vector::Unit(n, i));
        if (std::isfinite(end)) size = std::max(size, std::abs(end));
      }
    return size;
  }
  /// weight times the unit vector away from the set, 0 when the distance is rounding.
  Vector slope(const Vector& away, const Vector& x) const {
    const double length = away.norm();
    if (!(length > membership_tolerance * x.norm())) return Vector::Zero(x.size());
    return (weight_ / length) * away;
  }
  Function ball() const {
    const Call set{"ball2", {argument("radius", weight_)}};
    return named("indicator", {argument(set)}, std::max<Index>(dimension(), 1));
  }

  Set set_;
  double weight_;
};

}  // namespace

Function distance(const Set& set, double weight) {
  require_positive(weight, "distance", "weight");
  return Function(std::make_shared<Distance>(set, weight));
}

}  // namespace convex::inline operations
