#include "convex/prox_formulas/norm_p.hpp"

#include <cmath>
#include <limits>

#include "convex/prox_formulas/norm2.hpp"
#include "convex/prox_formulas/scalar_prox.hpp"
#include "convex/prox_formulas/simplex.hpp"

namespace convex::prox_formulas {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// The root y >= 0 of a y + b y^e = z, for a, b >= 0 not both 0, e > 0.
double root_of_two_terms(double a, double b, double e, double z) {
  if (!(z > 0)) return 0;
  const double by_line = a > 0 ? z / a : endless, by_power = b > 0 ? std::pow(z / b, 1 / e) : endless;
  const double high = std::min(by_line, by_power);
  if (!(a > 0 && b > 0) || !(high > 0)) return high;
  return increasing_root(
      [&](double y) {
        const double power = std::pow(y, e);
        return std::pair(a * y + b * power - z, a + b * e * power / y);
      },
      0, high, high * 0.75);
}

/// A point and the number that it belongs to.
struct OnSphere {
  Vector y;
  double number;
};

/// y with line y_i + power y_i^(p-1) = z_i and |y|_p = 1, one of the two numbers being sought: it lies
/// between 0 and `high`, where |y|_p <= 1.
OnSphere on_unit_sphere(const Vector& z, double known, bool line_is_sought, double p, double high) {
  Vector y(z.size());
  const auto at = [&](double sought) {
    const double line = line_is_sought ? sought : known, power = line_is_sought ? known : sought;
    double sum = 0, rate = 0;
    for (Index i = 0; i < z.size(); ++i) {
      y[i] = root_of_two_terms(line, power, p - 1, z[i]);
      if (!(y[i] > 0)) continue;
      const double to_p = std::pow(y[i], p), bent = power * (p - 1) * to_p / y[i] / y[i];
      sum += to_p;
      rate += p * to_p / y[i] * (line_is_sought ? y[i] : to_p / y[i]) / (line + bent);
    }
    return std::pair(1 - sum, rate);
  };
  const double found = increasing_root(at, 0, high, high);
  at(found);
  return {y, found};
}

}  // namespace

double dual_exponent(double p) { return p == 1 ? endless : std::isinf(p) ? 1 : p / (p - 1); }

double norm_p(const Vector& x, double p) {
  const double top = x.size() == 0 ? 0 : x.cwiseAbs().maxCoeff();
  if (!(top > 0) || std::isinf(p)) return top;
  if (p == 2) return x.stableNorm();
  return top * std::pow((x / top).cwiseAbs().array().pow(p).sum(), 1 / p);
}

Vector prox_norm_p(const Vector& z, double weight, double p) {
  if (weight == 0) return z;
  if (p == 1) return (z.array() - weight).max(0.0);
  if (p == 2) return prox_norm2(z, weight);
  if (std::isinf(p)) return prox_norm_inf(z, weight);
  const double top = z.size() == 0 ? 0 : z.maxCoeff();
  if (norm_p(z, dual_exponent(p)) <= weight) return Vector::Zero(z.size());
  const Vector unit = z / top;
  const double w = weight / top;
  // Where p is near 1, y^(p-1) is some number though y is none but 0.
  const auto [y, line] = on_unit_sphere(unit, w, true, p, norm_p(unit, p));
  return top * line * y;
}

Vector proj_ball_p(const Vector& z, double radius, double p) {
  if (p == 1) return proj_ball1(z, radius);
  if (p == 2) return proj_ball2(z, radius);
  if (std::isinf(p)) return z.cwiseMin(radius);
  if (norm_p(z, p) <= radius) return z;
  if (radius == 0) return Vector::Zero(z.size());
  const double top = z.maxCoeff();
  const Vector unit = z / top;
  return radius * on_unit_sphere(unit, radius / top, false, p, norm_p(unit, dual_exponent(p))).y;
}

Matrix prox_norm_p_jacobian(const Vector& z, double weight, double p) {
  const Index n = z.size();
  if (weight == 0) return Matrix::Identity(n, n);
  if (p == 1) return (z.array() > weight).cast<double>().matrix().asDiagonal();
  if (std::isinf(p)) return prox_norm_inf_jacobian(z, weight, Vector::Ones(n));
  const Vector x = prox_norm_p(z, weight, p);
  const double s = norm_p(x, p);
  if (!(s > 0)) return Matrix::Zero(n, n);
  // The inverse of 1 + c (diag y^(p-2) - u uᵀ), u = y^(p-1), c = weight (p-1)/s, by Sherman and Morrison.
  const Vector y = x / s, u = y.array().pow(p - 1);
  const double c = weight * (p - 1) / s;
  Vector shrink(n);
  for (Index i = 0; i < n; ++i) {
    const double bend = p == 2 ? 1 : y[i] > 0 ? std::pow(y[i], p - 2) : p < 2 ? endless : 0;
    shrink[i] = 1 / (1 + c * bend);
  }
  const Vector moved = shrink.cwiseProduct(u);
  const double left = y.array().pow(p).matrix().dot(shrink);  // 1 - c u·moved
  Matrix J = shrink.asDiagonal();
  if (left > 0) J += c / left * moved * moved.transpose();
  return J;
}

}  // namespace convex::prox_formulas
