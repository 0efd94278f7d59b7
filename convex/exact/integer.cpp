#include "convex/exact/integer.hpp"

#include <gmp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace convex::inline exact_arithmetic {

static_assert(sizeof(long) == sizeof(std::int64_t), "GMP's signed words are taken as 64 bits");

/// GMP's view of an Integer.
class IntegerAccess {
 public:
  explicit IntegerAccess(const Integer& a) {
    if (a.big_ != nullptr) {
      value_ = static_cast<mpz_srcptr>(a.big_);
      return;
    }
    mpz_init_set_si(own_, a.small_);
    value_ = own_;
  }
  ~IntegerAccess() {
    if (value_ == own_) mpz_clear(own_);
  }
  IntegerAccess(const IntegerAccess&) = delete;
  IntegerAccess& operator=(const IntegerAccess&) = delete;
  operator mpz_srcptr() const { return value_; }  // NOLINT: this is what it is for

  /// Takes the value of an initialised mpz over and clears it.
  static Integer take(mpz_t value) {
    Integer result;
    if (mpz_fits_slong_p(value)) {
      result.small_ = mpz_get_si(value);
      mpz_clear(value);
    } else {
      auto* big = new __mpz_struct;
      *big = *value;
      result.big_ = big;
    }
    return result;
  }

 private:
  mpz_t own_;
  mpz_srcptr value_ = nullptr;
};

namespace {

using View = IntegerAccess;

template <class Operation>
Integer made(Operation operation) {
  mpz_t result;
  mpz_init(result);
  operation(result);
  return View::take(result);
}

}  // namespace

void* Integer::copy(const void* big) {
  auto* made_copy = new __mpz_struct;
  mpz_init_set(made_copy, static_cast<mpz_srcptr>(big));
  return made_copy;
}

void Integer::release(void* big) {
  auto* value = static_cast<mpz_ptr>(big);
  mpz_clear(value);
  delete value;
}

Integer Integer::shifted(std::int64_t value, unsigned long exponent) {
  return made([&](mpz_t r) { mpz_mul_2exp(r, View(value), exponent); });
}

Integer Integer::from_digits(const std::string& digits) {
  return made([&](mpz_t r) { mpz_set_str(r, digits.c_str() + (digits.starts_with('+') ? 1 : 0), 10); });
}

Integer Integer::from_gmp(const void* value) {
  return made([&](mpz_t r) { mpz_set(r, static_cast<mpz_srcptr>(value)); });
}

int Integer::sign() const {
  if (big_ != nullptr) return mpz_sgn(static_cast<mpz_srcptr>(big_));
  return (small_ > 0) - (small_ < 0);
}

std::size_t Integer::bits() const { return is_zero() ? 0 : mpz_sizeinbase(View(*this), 2); }

std::string Integer::text() const {
  if (big_ == nullptr) return std::to_string(small_);
  const auto value = static_cast<mpz_srcptr>(big_);
  std::string digits(mpz_sizeinbase(value, 10) + 2, '\0');
  mpz_get_str(digits.data(), 10, value);
  digits.resize(digits.find('\0'));
  return digits;
}

Integer Integer::operator-() const { return Integer(0) - *this; }

Integer Integer::slow_sum(const Integer& a, const Integer& b) {
  return made([&](mpz_t r) { mpz_add(r, View(a), View(b)); });
}
Integer Integer::slow_difference(const Integer& a, const Integer& b) {
  return made([&](mpz_t r) { mpz_sub(r, View(a), View(b)); });
}
Integer Integer::slow_product(const Integer& a, const Integer& b) {
  return made([&](mpz_t r) { mpz_mul(r, View(a), View(b)); });
}

int Integer::compare(const Integer& a, const Integer& b) {
  if (a.is_small(b)) return (a.small_ > b.small_) - (a.small_ < b.small_);
  return mpz_cmp(View(a), View(b));
}

Integer exact_quotient(const Integer& a, const Integer& b) {
  if (a.is_small(b) && b.small_ != -1) return a.small_ / b.small_;
  return made([&](mpz_t r) { mpz_divexact(r, View(a), View(b)); });
}

Integer truncated_quotient(const Integer& a, const Integer& b) {
  if (a.is_small(b) && b.small_ != -1) return a.small_ / b.small_;
  return made([&](mpz_t r) { mpz_tdiv_q(r, View(a), View(b)); });
}

Integer difference_of_products(const Integer& a, const Integer& b, const Integer& c, const Integer& d) {
  std::int64_t first = 0, second = 0, difference = 0;
  if (a.is_small(b) && c.is_small(d) && !__builtin_mul_overflow(a.small_, b.small_, &first) &&
      !__builtin_mul_overflow(c.small_, d.small_, &second) &&
      !__builtin_sub_overflow(first, second, &difference))
    return difference;
  return made([&](mpz_t r) {
    mpz_mul(r, View(a), View(b));
    mpz_submul(r, View(c), View(d));
  });
}

bool is_multiple(const Integer& a, const Integer& b) {
  if (a.is_small(b)) return b.small_ == -1 || a.small_ % b.small_ == 0;
  return mpz_divisible_p(View(a), View(b)) != 0;
}

Integer greatest_common_divisor(const Integer& a, const Integer& b) {
  constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
  if (a.is_small(b) && a.small_ != lowest && b.small_ != lowest) return std::gcd(a.small_, b.small_);
  return made([&](mpz_t r) { mpz_gcd(r, View(a), View(b)); });
}

double nearest_quotient(const Integer& a, const Integer& b) {
  constexpr std::int64_t largest_exact = std::int64_t{1} << 53;
  if (a.is_small(b) && a.small_ >= -largest_exact && a.small_ <= largest_exact && b.small_ <= largest_exact)
    return static_cast<double>(a.small_) / static_cast<double>(b.small_);
  if (a.is_zero()) return 0;
  // The quotient as an integer with at least two bits more than the double will have, its last bit set when
  // something is left ("sticky"): one rounding of it is that of the quotient.
  constexpr long wanted = 64, mantissa = 53, last_place_of_all = -1074;
  const long shift =
      std::min(wanted - static_cast<long>(a.bits()) + static_cast<long>(b.bits()), 2 - last_place_of_all);
  mpz_t quotient, rest, divisor;
  mpz_init(quotient);
  mpz_init(rest);
  mpz_init(divisor);
  mpz_abs(rest, View(a));
  mpz_set(divisor, View(b));
  if (shift >= 0)
    mpz_mul_2exp(rest, rest, static_cast<unsigned long>(shift));
  else
    mpz_mul_2exp(divisor, divisor, static_cast<unsigned long>(-shift));
  mpz_tdiv_qr(quotient, rest, rest, divisor);
  if (mpz_sgn(rest) != 0) mpz_setbit(quotient, 0);
  const long bits = mpz_sgn(quotient) == 0 ? 0 : static_cast<long>(mpz_sizeinbase(quotient, 2));
  const long last_place = std::max(bits - mantissa - shift, last_place_of_all);
  const auto cut = static_cast<unsigned long>(last_place + shift);
  mpz_fdiv_r_2exp(rest, quotient, cut);
  mpz_fdiv_q_2exp(quotient, quotient, cut);
  mpz_set_ui(divisor, 0);
  mpz_setbit(divisor, cut - 1);
  const int order = mpz_cmp(rest, divisor);
  if (order > 0 || (order == 0 && mpz_odd_p(quotient))) mpz_add_ui(quotient, quotient, 1);
  const double kept = mpz_get_d(quotient);  // at most 2^53: exact
  for (mpz_ptr each : {quotient, rest, divisor}) mpz_clear(each);
  constexpr long beyond = 100000;
  const double magnitude = std::ldexp(kept, static_cast<int>(std::clamp(last_place, -beyond, beyond)));
  return a.sign() < 0 ? -magnitude : magnitude;
}

}  // namespace convex::inline exact_arithmetic
