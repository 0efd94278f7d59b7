#include <cmath>

#include "convex/double_double.hpp"
#include "convex/functions/convex_set.hpp"
#include "convex/functions/norms.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/parameter.hpp"

namespace convex::inline named_functions {
namespace {

/// {x : |x - center|₂ <= radius}; an empty center means 0 in any number of entries.
class Ball2 : public ConvexSet {
 public:
  Ball2(double radius, Vector center) : radius_(radius), center_(std::move(center)) {}
  Index dimension() const override { return center_.size(); }
  Call call() const override {
    Call call{"ball2", {argument("radius", radius_)}};
    if (center_.size() > 0) call.arguments.push_back(argument("center", center_));
    return call;
  }
  Call support_call() const override {
    return center_.size() > 0 ? ConvexSet::support_call() : Call{"norm2", {argument("weight", radius_)}};
  }
  Facts facts() const override {
    return {.cone = radius_ == 0 && center_.size() == 0, .radial = center_.isZero(0)};
  }
  bool bounded() const override { return true; }
  double scale() const override { return radius_ + center_.norm(); }

  Vector project(const Vector& z, const Vector&) const override {
    const Vector from = from_center(z);
    const double distance = from.stableNorm();
    if (distance <= radius_) return z;
    const Vector x = at_center(from * (radius_ / distance));
    return cancels(x) && is_squared_in_range(distance) ? on_sphere(z, center_) : x;
  }
  Jacobian project_jacobian(const Vector& z, const Vector&) const override {
    const Index n = z.size();
    const Vector from = from_center(z);
    const double distance = from.stableNorm();
    if (distance <= radius_) return Jacobian::identity(n);
    const double part = radius_ / distance;
    const Vector normal = from / distance;
    if (n < Jacobian::least_thin) return part * (Matrix::Identity(n, n) - normal * normal.transpose());
    return {Vector::Constant(n, part), normal, Matrix::Constant(1, 1, -part)};
  }
  double support(const Vector& v) const override { return support_value(v).value; }
  /// radius |v| + center·v, in twice the working precision where the two may cancel.
  Value support_value(const Vector& v) const override {
    const double length = v.stableNorm(), along = radius_ * length;
    if (center_.size() == 0) return sum_of_terms(along, along);
    const double plain = along + center_.dot(v), sizes = along + center_.cwiseAbs().dot(v.cwiseAbs());
    const double roundings = static_cast<double>(v.size());
    if (length == 1 && v.lpNorm<1>() == 1) {  // along an axis it is one sum, whose rounding is a double
      const DoubleDouble sum = two_sum(radius_, center_.dot(v));
      return {sum.hi, std::abs(sum.lo)};
    }
    if (!is_squared_in_range(length)) return sum_of_terms(plain, roundings * sizes);
    RunningSum square, sum;
    for (double e : v) square.add(two_product(e, e));
    const DoubleDouble back = two_product(length, length);
    square.add(-back.hi);
    square.add(-back.lo);
    sum.add(two_product(radius_, length));
    if (length > 0) sum.add(radius_ * (square.value() / (2 * length)));
    for (Index i = 0; i < v.size(); ++i) sum.add(two_product(center_[i], v[i]));
    const double found = sum.value();
    if (!std::isfinite(found)) return sum_of_terms(plain, roundings * sizes);  // products beyond doubles
    return sum_of_terms(found, std::abs(found) + roundings * unit_roundoff * sizes);
  }
  std::optional<Vector> maximiser(const Vector& v) const override {
    const double length = v.stableNorm();
    const Vector x = at_center(length > 0 ? Vector(v / length * radius_) : Vector::Zero(v.size()));
    return cancels(x) && length > 0 && is_squared_in_range(length) ? on_sphere(v, Vector::Zero(v.size())) : x;
  }
  /// Block soft thresholding (Combettes and Wajs 2005, example 2.16).
  Vector support_prox(const Vector& z, const Vector& d) const override {
    const double step = radius_ / d[0];
    const Vector shifted = center_.size() > 0 ? Vector(z - center_ / d[0]) : z;
    const double length = shifted.stableNorm();
    if (length <= step) return Vector::Zero(z.size());
    return shifted * ((length - step) / length);
  }

 private:
  /// Squares of numbers of this size, with their rounding errors, neither overflow nor underflow.
  static bool is_squared_in_range(double size) { return size == 0 || (size > 0x1p-400 && size < 0x1p400); }
  /// Is an entry of x lost beside that of the center?
  bool cancels(const Vector& x) const {
    constexpr double few = 0x1p-4;
    return center_.size() > 0 && (x.cwiseAbs().array() < few * center_.cwiseAbs().array()).any();
  }
  /// center + radius (z - c)/|z - c| in twice the working precision, rounded once.
  Vector on_sphere(const Vector& z, const Vector& c) const {
    const Index n = z.size();
    DoubleDoubleVector from(n);
    RunningSum square;
    for (Index i = 0; i < n; ++i) {
      const DoubleDouble e = two_sum(z[i], -c[i]);
      from.hi[i] = e.hi;
      from.lo[i] = e.lo;
      square.add(two_product(e.hi, e.hi));
      square.add(2 * e.hi * e.lo);
    }
    const double length = std::sqrt(square.value());
    square.add(negative(two_product(length, length)));
    const DoubleDouble ratio = quotient({radius_, 0}, two_sum(length, square.value() / (2 * length)));
    Vector x(n);
    for (Index i = 0; i < n; ++i) {
      const DoubleDouble step = convex::add(product(ratio, from.hi[i]), two_product(ratio.hi, from.lo[i]));
      x[i] = convex::add({center_[i], 0}, step).value();
    }
    return x;
  }
  Vector from_center(const Vector& z) const { return center_.size() > 0 ? Vector(z - center_) : z; }
  Vector at_center(const Vector& x) const { return center_.size() > 0 ? Vector(x + center_) : x; }
  double radius_;
  Vector center_;
};

}  // namespace

Set ball2(double radius, const Vector& center) {
  require_nonnegative("ball2", "radius", radius);
  require_finite("ball2", "center", center);
  return set_of(std::make_shared<Ball2>(radius, center));
}

Function norm2(double weight) {
  require_nonnegative("norm2", "weight", weight);
  return support_of(std::make_shared<Ball2>(weight, Vector()));
}

}  // namespace convex::inline named_functions
