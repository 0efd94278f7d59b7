#include <cmath>

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
    return at_center(from * (radius_ / distance));
  }
  Matrix project_jacobian(const Vector& z, const Vector&) const override {
    const Index n = z.size();
    const Vector from = from_center(z);
    const double distance = from.stableNorm();
    if (distance <= radius_) return Matrix::Identity(n, n);
    const Vector normal = from / distance;
    return radius_ / distance * (Matrix::Identity(n, n) - normal * normal.transpose());
  }
  double support(const Vector& v) const override {
    return radius_ * v.stableNorm() + (center_.size() > 0 ? center_.dot(v) : 0);
  }
  std::optional<Vector> maximiser(const Vector& v) const override {
    const double length = v.stableNorm();
    return at_center(length > 0 ? Vector(v / length * radius_) : Vector::Zero(v.size()));
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
