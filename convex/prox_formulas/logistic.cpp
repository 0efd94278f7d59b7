#include "convex/prox_formulas/logistic.hpp"

#include <numbers>

#include "convex/prox_formulas/relative_entropy.hpp"

namespace convex::prox_formulas {

namespace {

/// The root of v + p/(1 + e^-v) = c for c <= p/2, so v <= 0. There e^v/2 <= 1/(1 + e^-v) <= e^v.
double lower_half(double c, double p) {
  const double upper = std::min(0.0, prox_exponential(c, 1, p / 2).x);
  return increasing_root(
      [&](double v) {
        const double e = std::exp(v), sigma = e / (1 + e);
        return std::pair{v - c + p * sigma, 1 + p * sigma / (1 + e)};
      },
      upper - 1, 0.5, upper);
}

}  // namespace

ScalarProx prox_logistic(double z, double d) {
  const double p = 1 / d;
  double x = 0;
  if (z <= p / 2) {
    x = lower_half(z, p);
  } else {
    const double rest = std::fma(-d, z, 1);  // 1 - dz with one rounding, whatever cancels
    x = -lower_half(std::isfinite(rest) ? rest / d : p - z, p);
  }
  const double e = std::exp(-std::abs(x)), curvature = e / ((1 + e) * (1 + e));
  return {x, 1 / (1 + p * curvature)};
}

ScalarProx prox_binary_entropy(double z, double d) {
  const double c = z <= 0.5 ? z : 1 - z;
  const double free = prox_exponential_conjugate(c, d).x;  // log free + d free = dc
  // log(y/free) - log(1 - y) + d(y - free) = 0, convex and increasing in log y.
  double y = std::min(free, 0.5);
  if (y > 0)
    for (double last = std::numeric_limits<double>::infinity();;) {
      const double value = std::log(y / free) - std::log1p(-y) + d * (y - free);
      const double step = value / (1 / (1 - y) + d * y);
      y *= std::exp(-step);
      // Quadratic: after a step below 2⁻³⁰ the next is rounding. A step that does not shrink is.
      if (!(std::abs(step) > 0x1p-30 && std::abs(step) < last)) break;
      last = std::abs(step);
    }
  const double t = d * y * (1 - y);
  return {z <= 0.5 ? y : 1 - y, 1 / (1 + 1 / t)};
}

}  // namespace convex::prox_formulas
