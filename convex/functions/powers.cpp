#include <cmath>

#include "convex/double_double.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/scalar_sum.hpp"
#include "convex/functions/separable_functions.hpp"
#include "convex/gamma0/parameter.hpp"
#include "convex/infinity.hpp"
#include "convex/prox_formulas/power.hpp"

namespace convex::inline named_functions {
namespace {

/// (x / c)^(a / b), x, c, a > 0: what the rounding of both quotients is worth, which the power enlarges, is
/// made up for to first order.
double power_of_quotient(double x, double c, double a, DoubleDouble b) {
  const double base = x / c, exponent = a / b.hi;
  const double plain = std::pow(base, exponent);
  const DoubleDouble x_of_base = two_product(base, c), a_of_exponent = two_product(exponent, b.hi);
  const double of_base = ((x - x_of_base.hi) - x_of_base.lo) / x;
  const double of_exponent = ((a - a_of_exponent.hi) - a_of_exponent.lo - exponent * b.lo) / b.hi;
  const double more = exponent * std::log1p(of_base) + of_exponent * std::log(base);
  return std::isfinite(plain) && std::isfinite(more) ? plain * std::exp(more) : plain;
}

/// |x|^p, p > 1.
struct Power : AnySize {
  double p;
  bool finite() const { return true; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }
  Call call() const { return {"power", {argument("p", p)}}; }
  Function conjugate() const;
  Ends domain(Index) const { return {}; }
  Ends slopes(Index) const { return {}; }
  double value(double x, Index) const { return std::pow(std::abs(x), p); }
  double slope(double x, Index) const { return std::copysign(p * std::pow(std::abs(x), p - 1), x); }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_power(z, d, p);
  }
};

/// (p - 1) |x/p|^(p/(p-1)).
struct PowerConjugate : AnySize {
  double p;
  double q() const { return p / (p - 1); }
  bool finite() const { return true; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }
  Call call() const {
    const Call stretched{"dilate", {argument(Call{"power", {argument("p", q())}}), argument("rho", p)}};
    return {"scale", {argument(stretched), argument("alpha", p - 1)}};
  }
  Function conjugate() const { return power(p); }
  Ends domain(Index) const { return {}; }
  Ends slopes(Index) const { return {}; }
  double value(double x, Index) const {
    return (p - 1) * power_of_quotient(std::abs(x), p, p, two_sum(p, -1));
  }
  double slope(double x, Index) const { return std::copysign(std::pow(std::abs(x) / p, 1 / (p - 1)), x); }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_power_conjugate(z, d, p);
  }
};

struct InversePower : AnySize {
  double q;
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }  // open: no point outside counts as inside
  Call call() const { return {"inverse_power", {argument("q", q)}}; }
  Function conjugate() const;
  Ends domain(Index) const { return {.low = 0}; }
  Ends slopes(Index) const { return {.high = 0}; }
  double value(double x, Index) const { return x > 0 ? std::pow(x, -q) : infinity; }
  double slope(double x, Index) const { return x > 0 ? -q * std::pow(x, -q - 1) : -infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_inverse_power(z, d, q);
  }
};

/// -(1 + q) (-x/q)^(q/(1+q)) on x <= 0.
struct InversePowerConjugate : AnySize {
  double q;
  double r() const { return q / (1 + q); }
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {.high = 0}; }
  Call call() const {
    const Call mirrored{"dilate",
                        {argument(Call{"negative_power", {argument("r", r())}}), argument("rho", -q)}};
    return {"scale", {argument(mirrored), argument("alpha", 1 + q)}};
  }
  Function conjugate() const { return inverse_power(q); }
  Ends domain(Index) const { return {.high = 0}; }
  Ends slopes(Index) const { return {.low = 0}; }
  double value(double x, Index) const {
    return x > 0 ? infinity : -(1 + q) * power_of_quotient(-x, q, q, two_sum(q, 1));
  }
  double slope(double x, Index) const { return x < 0 ? std::pow(-x / q, -1 / (1 + q)) : infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    return prox_formulas::prox_inverse_power_conjugate(z, d, q);
  }
};

/// -x^r on x >= 0: with q = r/(1-r) and h the conjugate of t^-q it is h(-x) / ((1+q) q^-r).
struct NegativePower : AnySize {
  double r;
  double q() const { return r / (1 - r); }
  double factor() const { return (1 + q()) * std::pow(q(), -r); }
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {.low = 0}; }
  Call call() const { return {"negative_power", {argument("r", r)}}; }
  Function conjugate() const;
  Ends domain(Index) const { return {.low = 0}; }
  Ends slopes(Index) const { return {.high = 0}; }
  double value(double x, Index) const { return x < 0 ? infinity : -std::pow(x, r); }
  double slope(double x, Index) const { return x > 0 ? -r * std::pow(x, r - 1) : -infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    const prox_formulas::ScalarProx mirrored =
        prox_formulas::prox_inverse_power_conjugate(-z, factor() * d, q());
    return {-mirrored.x, mirrored.slope};
  }
};

/// (1-r) r^q (-x)^-q on x < 0, q = r/(1-r).
struct NegativePowerConjugate : AnySize {
  double r;
  double q() const { return r / (1 - r); }
  double factor() const { return (1 - r) * std::pow(r, q()); }
  bool finite() const { return false; }
  bool smooth() const { return true; }
  Ends ends(Index) const { return {}; }
  Call call() const {
    const Call mirrored{"dilate",
                        {argument(Call{"inverse_power", {argument("q", q())}}), argument("rho", -r)}};
    return {"scale", {argument(mirrored), argument("alpha", 1 - r)}};
  }
  Function conjugate() const { return negative_power(r); }
  Ends domain(Index) const { return {.high = 0}; }
  Ends slopes(Index) const { return {.low = 0}; }
  double value(double x, Index) const {
    return x < 0 ? (1 - r) * power_of_quotient(r, -x, r, two_sum(1, -r)) : infinity;
  }
  double slope(double x, Index) const { return x < 0 ? factor() * q() * std::pow(-x, -q() - 1) : infinity; }
  prox_formulas::ScalarProx prox(double z, double d, Index) const {
    const prox_formulas::ScalarProx mirrored = prox_formulas::prox_inverse_power(-z, d / factor(), q());
    return {-mirrored.x, mirrored.slope};
  }
};

Function Power::conjugate() const { return scalar_sum(PowerConjugate{{}, p}); }
Function InversePower::conjugate() const { return scalar_sum(InversePowerConjugate{{}, q}); }
Function NegativePower::conjugate() const { return scalar_sum(NegativePowerConjugate{{}, r}); }

}  // namespace

Function power(double p) {
  require_finite("power", "p", p);
  if (p < 1) throw InvalidInput("power(p): less than 1; |x|^p would not be convex, give 1 or more");
  if (p == 1) return norm1(1);
  if (p == 2) return squared_norm2(2);  // quadratic: exact in any metric
  return scalar_sum(Power{{}, p});
}

Function inverse_power(double q) {
  require_positive("inverse_power", "q", q);
  return scalar_sum(InversePower{{}, q});
}

Function negative_power(double r) {
  require_finite("negative_power", "r", r);
  if (!(r > 0 && r < 1)) throw InvalidInput("negative_power(r): not between 0 and 1; give 0 < r < 1");
  return scalar_sum(NegativePower{{}, r});
}

}  // namespace convex::inline named_functions
