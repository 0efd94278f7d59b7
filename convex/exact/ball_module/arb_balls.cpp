// A shared module, loaded when balls are asked for and not before: what Arb links to (FLINT, MPFR) costs time
// at the start of a process.
#include <arb.h>
#include <flint/fmpq.h>
#include <gmp.h>

#include <cmath>
#include <cstdlib>

#include "convex/exact/ball_module/ball_operations.hpp"

namespace {

using convex::BallFunction;

arb_struct* ball(void* handle) { return static_cast<arb_struct*>(handle); }
const arb_struct* ball(const void* handle) { return static_cast<const arb_struct*>(handle); }

void* make() {
  auto* result = new arb_struct;
  arb_init(result);
  return result;
}

void release(void* handle) {
  arb_clear(ball(handle));
  delete ball(handle);
}

void set_fraction(void* result, const char* p, const char* q, long precision) {
  fmpq_t fraction;
  fmpq_init(fraction);
  fmpz_set_str(fmpq_numref(fraction), p, 10);
  fmpz_set_str(fmpq_denref(fraction), q, 10);
  fmpq_canonicalise(fraction);
  arb_set_fmpq(ball(result), fraction, precision);
  fmpq_clear(fraction);
}

void apply(void* result, int function, const void* left, const void* right, long precision) {
  arb_struct* y = ball(result);
  const arb_struct *a = ball(left), *b = ball(right);
  switch (static_cast<BallFunction>(function)) {
    case BallFunction::negate:
      return arb_neg(y, a);
    case BallFunction::add:
      return arb_add(y, a, b, precision);
    case BallFunction::subtract:
      return arb_sub(y, a, b, precision);
    case BallFunction::multiply:
      return arb_mul(y, a, b, precision);
    case BallFunction::divide:
      return arb_div(y, a, b, precision);
    case BallFunction::power:
      return arb_pow(y, a, b, precision);
    case BallFunction::sin:
      return arb_sin(y, a, precision);
    case BallFunction::cos:
      return arb_cos(y, a, precision);
    case BallFunction::tan:
      return arb_tan(y, a, precision);
    case BallFunction::asin:
      return arb_asin(y, a, precision);
    case BallFunction::acos:
      return arb_acos(y, a, precision);
    case BallFunction::atan:
      return arb_atan(y, a, precision);
    case BallFunction::atan2:
      return arb_atan2(y, a, b, precision);
    case BallFunction::sinh:
      return arb_sinh(y, a, precision);
    case BallFunction::cosh:
      return arb_cosh(y, a, precision);
    case BallFunction::tanh:
      return arb_tanh(y, a, precision);
    case BallFunction::exp:
      return arb_exp(y, a, precision);
    case BallFunction::log:
      return arb_log(y, a, precision);
    case BallFunction::sqrt:
      return arb_sqrt(y, a, precision);
    case BallFunction::pi:
      return arb_const_pi(y, precision);
  }
  arb_indeterminate(y);
}

int sign(const void* handle) {
  return arb_is_positive(ball(handle)) != 0 ? 1 : arb_is_negative(ball(handle)) != 0 ? -1 : 0;
}

/// Exponents beyond this would make integers that no one can hold.
constexpr long largest_exponent = 100000;

int is_finite(const void* handle) {
  if (arb_is_finite(ball(handle)) == 0) return 0;
  const arf_struct* middle = arb_midref(ball(handle));
  if (arf_is_zero(middle) != 0) return 1;
  return static_cast<int>(arf_cmpabs_2exp_si(middle, largest_exponent) < 0 &&
                          arf_cmpabs_2exp_si(middle, -largest_exponent) > 0);
}

char* midpoint(const void* handle, long* exponent) {
  fmpz_t mantissa, power;
  fmpz_init(mantissa);
  fmpz_init(power);
  arf_get_fmpz_2exp(mantissa, power, arb_midref(ball(handle)));
  char* digits = nullptr;
  if (fmpz_fits_si(power) != 0) {
    *exponent = fmpz_get_si(power);
    digits = fmpz_get_str(nullptr, 10, mantissa);
  }
  fmpz_clear(mantissa);
  fmpz_clear(power);
  return digits;
}

double radius(const void* handle) {
  if (arb_is_exact(ball(handle)) != 0) return 0;
  arf_t bound;
  arf_init(bound);
  arf_set_mag(bound, arb_radref(ball(handle)));
  const double rounded = arf_get_d(bound, ARF_RND_UP);
  arf_clear(bound);
  return rounded > 0 ? rounded : std::nextafter(0.0, 1.0);
}

constexpr convex::BallOperations operations{make, release,   set_fraction, apply,
                                            sign, is_finite, midpoint,     radius};

}  // namespace

extern "C" const convex::BallOperations* moreau_balls() { return &operations; }
