#include "convex/prox_formulas/exponential_cone.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "convex/double_double.hpp"
#include "convex/infinity.hpp"
#include "convex/prox_formulas/lambert.hpp"
#include "convex/prox_formulas/scalar_prox.hpp"

namespace convex::prox_formulas {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// e^-700 is all but zero beside 1, and e^700 is still a double: beyond it a ray is an edge of the cone.
constexpr double last_exponent = 700;
/// An entry so small beside the others is zero to any rounding, and not worth a ratio that overflows.
constexpr double negligible = 0x1p-960;

/// Where e^x leaves the range of doubles, x.lo is no longer small.
double exp(DoubleDouble x) {
  return std::abs(x.hi) < last_exponent ? std::exp(x.hi) * (1 + x.lo) : std::exp(x.hi);
}

DoubleDouble quotient(double a, double b) {
  const double q = a / b;
  return {q, std::fma(-q, b, a) / b};
}

/// Where z lies, after division by a power of two.
enum class Region {
  cone,
  polar,
  back_face,  ///< x, y <= 0: the nearest point has y = 0
  ray,        ///< on the curved boundary
  t_axis,     ///< as `ray` with rho too large: (0, 0, t+)
  t_zero      ///< as `ray` with rho too negative: (x, y, 0)
};

struct Ray {
  DoubleDouble rho;
  double A = 0, B = 0, up = 0, down = 0;  ///< up = A e^rho, down = B e^-rho
};

struct Split {
  Region region;
  Ray ray;
};

/// The rays at a distance from one end of the interval of rho. from_low: the end where A vanishes.
struct Interval {
  double x, y;       // of z
  DoubleDouble end;  // 1 - y/x or x/y
  double width;      // to the other end, may be infinite
  bool from_low;

  Ray at(double distance, double correction) const {
    Ray ray;
    ray.rho = add(end, from_low ? two_sum(distance, correction) : two_sum(-distance, -correction));
    const double rho = ray.rho.hi, det = rho * rho - rho + 1, other = width - distance;
    if (from_low) {
      ray.A = x * distance / det;
      ray.B = std::isfinite(width) ? y * other / det : (x - rho * y) / det;
    } else {
      ray.B = y * distance / det;
      ray.A = std::isfinite(width) ? x * other / det : (y - (1 - rho) * x) / det;
    }
    ray.up = ray.A * exp(ray.rho);
    ray.down = ray.B * exp(negative(ray.rho));
    return ray;
  }
};

/// d(up - down)/d rho.
double derivative(const Ray& ray, double x, double y) {
  const double rho = ray.rho.hi, det = rho * rho - rho + 1, turn = (2 * rho - 1) / det;
  return exp(ray.rho) * (ray.A * (1 - turn) + x / det) +
         exp(negative(ray.rho)) * (ray.B * (1 + turn) + y / det);
}

Ray root(const Interval& interval, double t) {
  const double sign = interval.from_low ? 1 : -1;
  const auto excess = [&](const Ray& ray) {
    const double value = (ray.up - ray.down) - t;
    return std::pair{sign * value, derivative(ray, interval.x, interval.y)};
  };
  // Near the end one exponential and the vanishing factor matter: distance e^distance is known.
  const Ray end = interval.at(0, 0);
  const double rho = end.rho.hi, det = rho * rho - rho + 1;
  const double guess = interval.from_low
                           ? lambert_w(std::max(0.0, t + end.down) * std::exp(-rho) * det / interval.x)
                           : lambert_w(std::max(0.0, end.up - t) * std::exp(rho) * det / interval.y);
  const double longest = std::min(interval.width / 2, 2 * last_exponent),
               smallest = std::numeric_limits<double>::min();
  const double start = std::clamp(std::isfinite(guess) ? guess : longest, smallest, longest);
  const double exponent = increasing_root(
      [&](double log_distance) {
        const double distance = std::exp(log_distance);
        const auto [value, slope] = excess(interval.at(distance, 0));
        return std::pair{value, slope * distance};
      },
      std::log(smallest) - 1, std::log(longest) + 1, std::log(start));
  double distance = std::exp(exponent), correction = 0;
  for (int pass = 0; pass < 3; ++pass) {  // what the logarithm rounded, then what the distance rounds
    const auto [value, slope] = excess(interval.at(distance, 0));
    correction = -value / slope;
    if (!(std::abs(correction) < distance / 2)) return interval.at(distance, 0);
    if (pass < 2) distance += correction;
  }
  return interval.at(distance, correction);
}

bool in_cone(double x, double y, double t) {
  if (y > 0) return y * exp(quotient(x, y)) <= t;
  return y >= 0 && x <= 0 && t >= 0;
}

/// z = (x, y, t) with largest entry about 1.
Split split(double x, double y, double t) {
  if (in_cone(x, y, t)) return {Region::cone, {}};
  if (x > 0 ? x * exp(add(quotient(y, x), {-1, 0})) <= -t : x >= 0 && y <= 0 && t <= 0)
    return {Region::polar, {}};
  if (x <= 0 && y <= 0) return {Region::back_face, {}};
  if (y <= 0) {
    const DoubleDouble low = add({1, 0}, negative(quotient(y, x)));
    if (low.hi > last_exponent) return {Region::t_axis, {}};
    return {Region::ray, root({x, y, low, infinity, true}, t)};
  }
  const DoubleDouble high = quotient(x, y);
  if (x <= 0) {
    if (high.hi < -last_exponent) return {Region::t_zero, {}};
    return {Region::ray, root({x, y, high, infinity, false}, t)};
  }
  const DoubleDouble low = add({1, 0}, negative(quotient(y, x)));
  const double width = x / y + (y / x - 1);
  const Interval from_low{x, y, low, width, true}, from_high{x, y, high, width, false};
  const double middle = low.hi + width / 2;
  const Ray ray = from_low.at(width / 2, 0);
  const bool lower_half = middle > last_exponent || (middle > -last_exponent && ray.up - ray.down >= t);
  return {Region::ray, root(lower_half ? from_low : from_high, t)};
}

struct ScaledSplit {
  Vector3d z;  // divided by 2^exponent
  int exponent;
  Split split;
};

ScaledSplit scaled_split(const Vector3d& z) {
  const double largest = z.cwiseAbs().maxCoeff();
  const int k = largest > 0 ? std::ilogb(largest) : 0;
  const Vector3d w = z.unaryExpr([k](double v) {
    const double scaled = std::ldexp(v, -k);
    return std::abs(scaled) < negligible ? 0 : scaled;
  });
  return {w, k, split(w[0], w[1], w[2])};
}

Vector3d restored(const Vector3d& w, int k) {
  return w.unaryExpr([k](double v) { return std::ldexp(v, k); });
}

}  // namespace

Vector3d proj_exponential_cone(const Vector3d& z) {
  if (in_cone(z[0], z[1], z[2])) return z;
  const auto [w, k, parts] = scaled_split(z);
  const Ray& ray = parts.ray;
  switch (parts.region) {
    case Region::cone:
      return z;
    case Region::polar:
      return Vector3d::Zero();
    case Region::back_face:
      return {z[0], 0, std::max(z[2], 0.0)};
    case Region::t_axis:
      return {0, 0, std::max(z[2], 0.0)};
    case Region::t_zero:
      return {z[0], z[1], 0};
    case Region::ray:
      break;
  }
  return restored({ray.A * ray.rho.value(), ray.A, ray.up}, k);
}

Vector3d proj_exponential_polar(const Vector3d& z) {
  const auto [w, k, parts] = scaled_split(z);
  const Ray& ray = parts.ray;
  switch (parts.region) {
    case Region::cone:
      return Vector3d::Zero();
    case Region::polar:
      return z;
    case Region::back_face:
      return {0, z[1], std::min(z[2], 0.0)};
    case Region::t_axis:
      return {z[0], z[1], std::min(z[2], 0.0)};
    case Region::t_zero:
      return {0, 0, z[2]};
    case Region::ray:
      break;
  }
  return restored({ray.B, ray.B * ((1 - ray.rho.hi) - ray.rho.lo), -ray.down}, k);
}

Matrix3d proj_exponential_cone_jacobian(const Vector3d& z) {
  const auto [w, k, parts] = scaled_split(z);
  const double kept = z[2] > 0 ? 1 : 0;
  switch (parts.region) {
    case Region::cone:
      return Matrix3d::Identity();
    case Region::polar:
      return Matrix3d::Zero();
    case Region::back_face:
      return Vector3d(1, 0, kept).asDiagonal();
    case Region::t_axis:
      return Vector3d(0, 0, kept).asDiagonal();
    case Region::t_zero:
      return Vector3d(1, 1, 0).asDiagonal();
    case Region::ray:
      break;
  }
  const Ray& ray = parts.ray;
  const double rho = ray.rho.hi, e = std::exp(std::clamp(rho, -700.0, 700.0));  // beyond, an axis
  const Vector3d p = Vector3d(rho, 1, e).stableNormalized(),
                 n = Vector3d(1, 1 - rho, -1 / e).stableNormalized();
  const Vector3d c = p.cross(n);
  const double along = Vector3d(ray.A, 0, ray.up).dot(c), across = Vector3d(0, -ray.B, ray.down).dot(c);
  return p * p.transpose() + along / (along + across) * c * c.transpose();
}

}  // namespace convex::prox_formulas
