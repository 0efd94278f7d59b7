#include <algorithm>
#include <cmath>
#include <string>

#include "convex/composite/closed_form.hpp"
#include "convex/composite/metric_difference.hpp"
#include "convex/double_double.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/linear_quadratic/sets.hpp"

namespace convex::inline named_functions {
namespace {

/// {x : a·x <= b}, or {x : a·x = b} when two-sided: the projection is one multiplier in any metric. a, b are
/// kept divided by |a|; a = 0 stands for the whole space.
class Slab : public ConvexSet {
 public:
  Slab(Call call, const Vector& a, double b, bool two_sided)
      : call_(std::move(call)), a_(a), b_(b), given_a_(a), given_b_(b), two_sided_(two_sided) {
    const double length = a.stableNorm();
    if (length > 0) {
      a_ /= length;
      b_ /= length;
    }
  }
  Index dimension() const override { return a_.size(); }
  Call call() const override { return call_; }
  Facts facts() const override { return {.cone = given_b_ == 0, .piecewise_quadratic = true}; }
  bool bounded() const override { return false; }
  bool takes_any_diagonal() const override { return true; }
  bool recedes(const Vector& d) const override {
    const double along = a_.dot(d);
    return (two_sided_ ? std::abs(along) : along) <= membership_tolerance * d.norm();
  }
  double scale() const override { return std::abs(b_); }

  Vector project(const Vector& z, const Vector& d) const override {
    const Vector normal = a_.cwiseQuotient(d);
    const Vector x = z - multiplier(z, normal) * normal;
    return x - multiplier(x, normal) * normal;  // what the rounding of a far z left
  }
  Jacobian project_jacobian(const Vector& z, const Vector& d) const override {
    const Index n = z.size();
    const Vector normal = a_.cwiseQuotient(d);
    const bool active = two_sided_ ? !a_.isZero(0) : multiplier(z, normal) > 0;
    if (!active) return Jacobian::identity(n);
    const double square = a_.dot(normal);
    if (n >= Jacobian::least_thin && d.maxCoeff() == d.minCoeff())
      return {Vector::Ones(n), a_, Matrix::Constant(1, 1, -1 / (d[0] * square))};
    return Matrix::Identity(n, n) - normal * a_.transpose() / square;
  }
  double support(const Vector& v) const override { return support_value(v).value; }
  Value support_value(const Vector& v) const override {
    Value found = is_normal(v);
    if (found.value == 0) found.value = weight_of(v) * b_;
    found.error += sum_of_terms(found.value, std::abs(found.value)).error;
    return found;
  }
  std::optional<Vector> maximiser(const Vector& v) const override {
    if (is_normal(v).value > 0) return std::nullopt;
    return weight_of(v) != 0 || two_sided_ || b_ < 0 ? Vector(b_ * a_) : Vector::Zero(a_.size());
  }
  /// w b + ½ Σ d_i (w a_i - z_i)² is least at the w with w a·Da = a·Dz - b.
  Vector support_prox(const Vector& z, const Vector& d) const override {
    return multiplier(d.cwiseProduct(z), d.cwiseProduct(a_)) * a_;
  }
  /// With the numbers as given: divided by |a| they are those of another plane by a rounding, which may be
  /// far in a metric that is nearly singular.
  std::optional<Prox> project_general(const Vector& z, const Metric& W) const override {
    const double length = given_a_.stableNorm(), unit = length > 0 ? std::exp2(std::ilogb(length)) : 1;
    const Vector a = given_a_ / unit;  // exactly
    const double b = given_b_ / unit;
    const Vector normal = refined_solve(W, a);  // a is a covector; W makes it a direction
    const double square = a.dot(normal), excess = excess_at(z, a, b);
    if (!(square > 0) || (!two_sided_ && excess <= 0) || excess == 0)
      return closed_form(z, W, z, Vector::Zero(z.size()));
    double weight = excess / square;
    Vector x = z - weight * normal;
    // Refined once, on 0 = W(x - z) + weight a and a·x = b.
    x -= W.solve(stationarity(z, W, x, weight * a));
    const double rest = excess_at(x, a, b) / square;
    weight += rest;
    x -= rest * normal;
    const Vector v = weight * a;
    Prox found = closed_form(z, W, x, v);
    // How far x is from the plane and v from the line of a, where that is more than the rounding counted.
    Vector off(v.size());
    for (Index i = 0; i < v.size(); ++i) off[i] = std::fma(weight, a[i], -v[i]);
    const double missed = std::abs(excess_at(x, a, b)) / std::sqrt(square) + W.dual_norm(off);
    const double counted = roundings_of_a_formula * unit_roundoff * (W.norm(z) + W.norm(x));
    found.error_bound += std::max(0.0, missed - counted);
    return found;
  }
  std::optional<LinearQuadratic> indicator_form(Index) const override {
    return two_sided_ ? linear_quadratic::hyperplane(given_a_, given_b_)
                      : linear_quadratic::halfspace(given_a_, given_b_);
  }

 private:
  /// a·x - b in twice the precision, rounded once.
  static double excess_at(const Vector& x, const Vector& a, double b) {
    RunningSum sum;
    for (Index i = 0; i < x.size(); ++i) sum.add(two_product(a[i], x[i]));
    sum.add(-b);
    return sum.value();
  }
  double multiplier(const Vector& z, const Vector& normal) const {
    const double length = a_.dot(normal);
    if (!(length > 0)) return 0;
    const double excess = a_.dot(z) - b_;
    return (two_sided_ ? excess : std::max(0.0, excess)) / length;
  }
  /// The indicator of the v = wa, w >= 0 unless two-sided.
  Value is_normal(const Vector& v) const {
    const double weight = a_.dot(v), off = (v - weight * a_).stableNorm();
    return indicated(std::max(off, two_sided_ ? 0 : -weight), v.stableNorm());
  }
  double weight_of(const Vector& v) const {
    const double weight = a_.dot(v);
    return two_sided_ ? weight : std::max(0.0, weight);
  }
  Call call_;
  Vector a_;
  double b_;
  Vector given_a_;
  double given_b_;
  bool two_sided_;
};

void check(const char* set, const Vector& a, double b) {
  require_entries(set, "a", a);
  require_finite(set, "b", b);
  if (!a.isZero(0) && !std::isfinite(b / a.stableNorm()))
    throw InvalidInput(std::string(set) + ": b over the length of a is not a number; scale them");
}

}  // namespace

Set halfspace(const Vector& a, double b) {
  check("halfspace", a, b);
  if (a.isZero(0) && b < 0)
    throw InvalidInput("halfspace: a = 0 and b < 0, so the set is empty; give another a or b >= 0");
  const Call call{"halfspace", {argument("a", a), argument("b", b)}};
  return set_of(std::make_shared<Slab>(call, a, b, false));
}

Set hyperplane(const Vector& a, double b) {
  check("hyperplane", a, b);
  if (a.isZero(0) && b != 0)
    throw InvalidInput("hyperplane: a = 0 and b is not 0, so the set is empty; give another a or b = 0");
  const Call call{"hyperplane", {argument("a", a), argument("b", b)}};
  return set_of(std::make_shared<Slab>(call, a, b, true));
}

}  // namespace convex::inline named_functions
