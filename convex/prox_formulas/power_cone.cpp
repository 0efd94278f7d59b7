#include "convex/prox_formulas/power_cone.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::prox_formulas {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// An entry so small beside the others is zero to any rounding.
constexpr double negligible_entry = 0x1p-960;

enum class Region { cone, polar, flat, boundary };

/// The parts in the cone and in the polar, of data divided by a power of two.
struct Split {
  Region region;
  Vector3d x = Vector3d::Zero(), y = Vector3d::Zero();
};

/// x^alpha y^(1 - alpha) for x, y >= 0; the exponent that is used is at most ½, so it is exact as given.
double mean(double x, double y, double alpha) {
  if (!(x > 0 && y > 0)) return 0;
  return alpha <= 0.5 ? y * std::pow(x / y, alpha) : x * std::pow(y / x, 1 - alpha);
}

/// One coordinate of the pair: the positive root of c (c - a) = share · product, the coordinate of the
/// nearest point, and a - c; log of it, and d log c / d log product.
struct Coordinate {
  double root;  // sqrt(a² + 4 share product)
  double log, elasticity;
};

Coordinate coordinate(double a, double share, double log_product) {
  const double g = std::sqrt(share) * std::exp(log_product / 2);  // the product itself may underflow
  const double root = std::hypot(a, 2 * g);
  if (a > 0) return {root, std::log((a + root) / 2), 2 * g / (a + root) * (g / root)};
  // For a <= 0: share product / c = (root - a)/2.
  return {root, std::log(share) + log_product - std::log((root - a) / 2), (root - a) / 2 / root};
}

/// log(1 + e^s).
double softplus(double s) { return std::max(s, 0.0) + std::log1p(std::exp(-std::abs(s))); }

Split split(const Vector3d& z, double alpha) {
  const double x = z[0], y = z[1], height = std::abs(z[2]), beta = 1 - alpha;
  if (x >= 0 && y >= 0 && mean(x, y, alpha) >= height) return {Region::cone, z, Vector3d::Zero()};
  if (x <= 0 && y <= 0 && mean(-x / alpha, -y / beta, alpha) >= height)
    return {Region::polar, Vector3d::Zero(), z};
  if (!(height > 0)) return {Region::flat, z.cwiseMax(0.0), z.cwiseMin(0.0)};
  const double log_height = std::log(height);
  // s = log(r/(height - r)); the mean of the coordinates over r, in logarithms, falls from above 0 to below.
  const auto excess = [&](double s) {
    const double log_r = log_height - softplus(-s), log_rest = log_height - softplus(s);
    const Coordinate first = coordinate(x, alpha, log_r + log_rest),
                     second = coordinate(y, beta, log_r + log_rest);
    const double rest = 1 / (1 + std::exp(s)), share = 1 / (1 + std::exp(-s));
    const double value = alpha * first.log + beta * second.log - log_r;
    const double slope = (alpha * first.elasticity + beta * second.elasticity) * (rest - share) - rest;
    return std::pair{-value, -slope};
  };
  double lo = -1, hi = 1;  // widened until they hold the root, or it leaves the range of doubles
  while (excess(lo).first > 0 && lo > -0x1p20) lo *= 2;
  while (excess(hi).first < 0 && hi < 0x1p20) hi *= 2;
  double s = increasing_root(excess, lo, hi, (lo + hi) / 2);
  Vector3d point, normal;
  for (int pass = 0;; ++pass) {  // what the logarithms round, which are not small numbers, is put right
    const double r = height * (1 / (1 + std::exp(-s))), rest = height * (1 / (1 + std::exp(s)));
    const auto root_of = [&](double a, double share) {
      const double g = std::sqrt(share) * std::sqrt(r) * std::sqrt(rest), root = std::hypot(a, 2 * g);
      const double larger = (std::abs(a) + root) / 2, smaller = larger > 0 ? g * (g / larger) : 0;
      return a > 0 ? std::pair{larger, -smaller} : std::pair{smaller, -larger};
    };
    const auto [first, first_rest] = root_of(x, alpha);
    const auto [second, second_rest] = root_of(y, beta);
    point = {first, second, std::copysign(r, z[2])};
    normal = {first_rest, second_rest, std::copysign(rest, z[2])};
    const double value = std::log(mean(first, second, alpha) / r), slope = excess(s).second;
    const double step = value / slope;
    if (pass == 2 || !(std::abs(step) < 1e-6)) break;
    s += step;
  }
  return {Region::boundary, point, normal};
}

struct ScaledSplit {
  int exponent;
  Split split;
};

ScaledSplit scaled_split(const Vector3d& z, double alpha) {
  if (!(alpha > 0 && alpha < 1))
    throw InvalidInput("power_cone: alpha is " + std::to_string(alpha) + "; give a number between 0 and 1");
  const double largest = z.cwiseAbs().maxCoeff();
  const int k = largest > 0 ? std::ilogb(largest) : 0;
  const Vector3d w = z.unaryExpr([k](double v) {
    const double scaled = std::ldexp(v, -k);
    return std::abs(scaled) < negligible_entry ? 0 : scaled;
  });
  return {k, split(w, alpha)};
}

Vector3d restored(const Vector3d& w, int k) {
  return w.unaryExpr([k](double v) { return std::ldexp(v, k); });
}

/// The derivative along z where z = 0, x > 0 > y (or the reverse, with the exponents exchanged): r is of the
/// order of |z|^((1 - alpha)/alpha).
double flat_slope(const Vector3d& z, double alpha) {
  const double positive = std::max(z[0], z[1]), negative = -std::min(z[0], z[1]);
  const double exponent = z[0] > z[1] ? alpha : 1 - alpha;  // of the positive entry
  if (exponent > 0.5) return 1;
  if (exponent < 0.5) return 0;
  return positive / (positive + 2 * negative);
}

}  // namespace

Vector3d proj_power_cone(const Vector3d& z, double alpha) {
  const auto [k, parts] = scaled_split(z, alpha);
  if (parts.region == Region::cone) return z;
  return restored(parts.x, k);
}

Vector3d proj_power_polar(const Vector3d& z, double alpha) {
  const auto [k, parts] = scaled_split(z, alpha);
  if (parts.region == Region::polar) return z;
  return restored(parts.y, k);
}

Matrix3d proj_power_cone_jacobian(const Vector3d& z, double alpha) {
  const auto [k, parts] = scaled_split(z, alpha);
  const auto& [region, x, y] = parts;
  if (region == Region::cone) return Matrix3d::Identity();
  if (region == Region::polar) return Matrix3d::Zero();
  if (region == Region::flat)
    return Vector3d(z[0] > 0 ? 1 : 0, z[1] > 0 ? 1 : 0, flat_slope(z, alpha)).asDiagonal();
  const Vector3d p = x.stableNormalized(), n = y.stableNormalized(), c = p.cross(n);
  // How fast the two rays turn, times their lengths.
  const double along = Vector3d((1 - alpha) * x[0], -alpha * x[1], 0).dot(c),
               across = Vector3d(-(1 - alpha) * y[0], alpha * y[1], 0).dot(c);
  return p * p.transpose() + along / (along + across) * c * c.transpose();
}

}  // namespace convex::prox_formulas
