#include "convex/prox_formulas/relative_entropy.hpp"

#include "convex/prox_formulas/lambert.hpp"

namespace convex::prox_formulas {

namespace {

/// m 2^k, so that products of huge and tiny factors keep all digits.
struct Scaled {
  double m = 0;
  int k = 0;
  explicit Scaled(double a) { m = std::frexp(a, &k); }
  Scaled& operator*=(const Scaled& other) {
    int shift = 0;
    m = std::frexp(m * other.m, &shift);
    k += other.k + shift;
    return *this;
  }
  double value() const { return std::ldexp(m, k); }
};

}  // namespace

ScalarProx prox_kullback_leibler(double z, double d, double r) {
  if (!(r > 0)) return {0, 0};
  const double exponent = d * z;
  const double log_a = std::log(d) + std::log(r) + exponent;  // dx = t with t + log t = log a
  double x = 0;
  if (log_a > 500) {  // e^(log a) is or comes near an overflow; here x ≈ z - log(z/r)/d
    const double log_r = std::log(r);
    const double start = std::isfinite(log_a) ? (log_a - std::log(log_a)) / d : z;
    x = increasing_root(
        [&](double u) {
          return std::pair{u - z + (std::log(u) - log_r) / d, 1 + 1 / (d * u)};
        },
        start / 2, 2 * start, start);
  } else if (exponent < -1400) {
    const double t = lambert_w(std::exp(log_a));
    x = t / d;
  } else {
    const double lost = std::fma(d, z, -exponent);  // a rounding of dz is one of the digits of e^(dz)
    Scaled free(r);                                 // r e^(dz): x without the pull of ½du²
    const Scaled half(std::exp(exponent / 2));
    free *= half;
    free *= half;
    free *= Scaled(1 + lost);
    Scaled a = free;
    a *= Scaled(d);
    const double t = lambert_w(a.value());
    if (t < 1) {
      free *= Scaled(std::exp(-t));
      x = free.value();
    } else {
      x = t / d;
    }
  }
  return {x, 1 / (1 + 1 / (d * x))};
}

ScalarProx prox_exponential(double z, double d, double weight) {
  const double rho = weight / d;
  if (!(rho > 0)) return {z, 1};
  const double log_rho = std::log(rho), b = z + log_rho;  // v + e^v = b for v = x + log rho
  const auto pull = [&](double u) {
    const double half = std::exp(u / 2);  // e^u alone may overflow
    return half * rho * half;
  };
  const auto g = [&](double u) {
    const double p = pull(u);
    return std::pair{u - z + p, 1 + p};
  };
  // v lies in [log(b - log b), log b] for b > 1, in [b - e^b, b] otherwise; one is added for rounding.
  const double x =
      b > 1 ? increasing_root(g, std::log(b) - log_rho - 2, std::log(b) - log_rho + 1, std::log(b) - log_rho)
            : increasing_root(g, z - std::numbers::e - 1, z + 1, z);
  return {x, 1 / (1 + pull(x))};
}

}  // namespace convex::prox_formulas
