#include "convex/prox_formulas/simplex.hpp"

#include <cmath>
#include <string>

#include "convex/infinity.hpp"
#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/separable.hpp"
#include "convex/prox_formulas/top_level.hpp"
#include "convex/prox_formulas/water_level.hpp"

namespace convex::prox_formulas {

namespace {

void require_total(double total, const char* name) {
  if (!(total >= 0 && total < infinity))
    throw InvalidInput(std::string(name) + " is " + std::to_string(total) +
                       "; give a finite number that is not negative");
}

void require_points(const Vector& z, double total) {
  if (z.size() == 0 && total > 0)
    throw InvalidInput("simplex: no entries can sum to a positive total; the set is empty");
}

/// d / 2^k with its largest entry in [1, 2): the same metric up to a factor, and products with z are safe.
Vector balanced_metric(const Vector& z, const Vector& d) {
  if (d.size() != z.size())
    throw InvalidInput("metric: " + std::to_string(d.size()) + " weights for a point of " +
                       std::to_string(z.size()) + "; give one an entry");
  if (d.size() == 0) return d;
  if (!(d.minCoeff() > 0 && d.maxCoeff() < infinity))
    throw InvalidInput("metric: a weight is not positive and finite; give positive weights");
  return d.unaryExpr([k = std::ilogb(d.maxCoeff())](double w) { return std::ldexp(w, -k); });
}

/// δ_ij - (1/d_i)/Σ_S(1/d) over the support S of x, with the signs of x.
Matrix support_jacobian(const Vector& x, const Vector& d) {
  const Index n = x.size();
  Vector sign(n);
  for (Index i = 0; i < n; ++i) sign[i] = x[i] > 0 ? 1 : x[i] < 0 ? -1 : 0;
  const Vector share = sign.cwiseQuotient(d);
  const double sum = share.cwiseAbs().sum();
  Matrix J = sign.cwiseAbs().asDiagonal();
  if (sum > 0) J -= (share / sum) * sign.transpose();
  return J;
}

Vector signed_as(const Vector& x, const Vector& z) {
  return x.binaryExpr(z, [](double a, double b) { return a > 0 ? std::copysign(a, b) : 0; });
}

}  // namespace

Vector proj_simplex(const Vector& z, double total) {
  require_total(total, "simplex: the total");
  require_points(z, total);
  if (!(total > 0)) return Vector::Zero(z.size());
  return above_level(z, top_level(z, total, Values::signed_ones), Values::signed_ones);
}

Vector proj_simplex(const Vector& z, double total, const Vector& d) {
  require_total(total, "simplex: the total");
  require_points(z, total);
  const Vector metric = balanced_metric(z, d);
  if (!(total > 0)) return Vector::Zero(z.size());
  return clamped_to_total(z, metric, infinity, total);
}

Vector proj_ball1(const Vector& z, double radius) {
  require_total(radius, "ball1: the radius");
  if (sum_of_absolutes(z) <= radius) return z;
  if (!(radius > 0)) return Vector::Zero(z.size());
  return above_level(z, top_level(z, radius, Values::absolute_ones), Values::absolute_ones);
}

Vector proj_ball1(const Vector& z, double radius, const Vector& d) {
  require_total(radius, "ball1: the radius");
  const Vector metric = balanced_metric(z, d);
  if (sum_of_absolutes(z) <= radius) return z;
  if (!(radius > 0)) return Vector::Zero(z.size());
  return signed_as(clamped_to_total(z.cwiseAbs(), metric, infinity, radius), z);
}

Vector prox_max(const Vector& z, double weight) {
  require_total(weight, "max: the weight");
  if (z.size() == 0 || !(weight > 0)) return z;
  return proj_box(z, -infinity, top_level(z, weight, Values::signed_ones).value());
}

Vector prox_max(const Vector& z, double weight, const Vector& d) {
  require_total(weight, "max: the weight");
  const Vector metric = balanced_metric(z, d);
  if (z.size() == 0 || !(weight > 0)) return z;
  const double scaled = std::ldexp(weight, -std::ilogb(d.maxCoeff()));
  return proj_box(z, -infinity, exact_water_level(z, metric, infinity, scaled));
}

Vector prox_norm_inf(const Vector& z, double weight) {
  require_total(weight, "norm_inf: the weight");
  if (!(weight > 0)) return z;
  if (sum_of_absolutes(z) <= weight) return Vector::Zero(z.size());
  const double level = std::max(0.0, top_level(z, weight, Values::absolute_ones).value());
  return proj_box(z, -level, level);
}

Vector prox_norm_inf(const Vector& z, double weight, const Vector& d) {
  require_total(weight, "norm_inf: the weight");
  const Vector metric = balanced_metric(z, d);
  const double scaled = z.size() > 0 ? std::ldexp(weight, -std::ilogb(d.maxCoeff())) : 0;
  if (!(weight > 0)) return z;
  if (metric.dot(z.cwiseAbs()) <= scaled) return Vector::Zero(z.size());
  const double level = std::max(0.0, exact_water_level(z.cwiseAbs(), metric, infinity, scaled));
  return proj_box(z, -level, level);
}

Matrix proj_simplex_jacobian(const Vector& z, double total, const Vector& d) {
  return support_jacobian(proj_simplex(z, total, d), d);
}

Matrix proj_ball1_jacobian(const Vector& z, double radius, const Vector& d) {
  if (sum_of_absolutes(z) <= radius) return Matrix::Identity(z.size(), z.size());
  return support_jacobian(proj_ball1(z, radius, d), d);
}

Matrix prox_max_jacobian(const Vector& z, double weight, const Vector& d) {
  // d (z - x) is a point of the simplex, with support where z was lowered.
  const Matrix J = Matrix::Identity(z.size(), z.size());
  const Vector lowered = (z - prox_max(z, weight, d)).eval();
  return J - support_jacobian(lowered, d.cwiseInverse()).transpose();
}

Matrix prox_norm_inf_jacobian(const Vector& z, double weight, const Vector& d) {
  const Index n = z.size();
  const Vector x = prox_norm_inf(z, weight, d);
  if (!(x.cwiseAbs().maxCoeff() > 0)) return Matrix::Zero(n, n);
  return Matrix::Identity(n, n) - support_jacobian((z - x).eval(), d.cwiseInverse()).transpose();
}

}  // namespace convex::prox_formulas
