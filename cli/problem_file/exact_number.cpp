#include "cli/problem_file/exact_number.hpp"

#include <gmp.h>

#include <charconv>
#include <cmath>
#include <memory>

namespace cli {
namespace {

/// A decimal exponent beyond this is no number of a problem file, and its exact value would fill the memory.
constexpr long largest_exponent = 5000;

struct Rational {
  mpq_t value;
  Rational() { mpq_init(value); }
  ~Rational() { mpq_clear(value); }
  Rational(const Rational&) = delete;
  Rational& operator=(const Rational&) = delete;
};

/// Reads [+-]digits[.digits][e[+-]digits] exactly.
bool read_decimal(std::string text, Rational& into) {
  long exponent = 0;
  if (const std::size_t e = text.find_first_of("eE"); e != std::string::npos) {
    const char* first = text.data() + e + 1;
    const char* last = text.data() + text.size();
    if (first != last && *first == '+') ++first;
    const auto [end, error] = std::from_chars(first, last, exponent);
    if (error != std::errc() || end != last) return false;
    text.resize(e);
  }
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.erase(0, 1);
  if (const std::size_t point = text.find('.'); point != std::string::npos) {
    exponent -= static_cast<long>(text.size() - point - 1);
    text.erase(point, 1);
  }
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos) return false;
  if (std::abs(exponent) > largest_exponent) return false;
  mpz_set_str(mpq_numref(into.value), text.c_str(), 10);
  if (negative) mpz_neg(mpq_numref(into.value), mpq_numref(into.value));
  mpz_t power;
  mpz_init(power);
  mpz_ui_pow_ui(power, 10, static_cast<unsigned long>(std::abs(exponent)));
  if (exponent >= 0)
    mpz_mul(mpq_numref(into.value), mpq_numref(into.value), power);
  else
    mpz_set(mpq_denref(into.value), power);
  mpz_clear(power);
  mpq_canonicalize(into.value);
  return true;
}

/// GMP truncates; the nearer of the truncation and its neighbour away from zero is the rounding.
double rounded(const Rational& exact) {
  const double below = mpq_get_d(exact.value);
  const double above = std::nextafter(below, mpq_sgn(exact.value) < 0 ? -INFINITY : INFINITY);
  if (!std::isfinite(above)) return below;
  Rational low, high;
  mpq_set_d(low.value, below);
  mpq_set_d(high.value, above);
  mpq_sub(low.value, exact.value, low.value);
  mpq_sub(high.value, high.value, exact.value);
  mpq_abs(low.value, low.value);
  mpq_abs(high.value, high.value);
  const int order = mpq_cmp(low.value, high.value);
  if (order != 0) return order < 0 ? below : above;
  int exponent = 0;
  const double mantissa = std::ldexp(std::frexp(below, &exponent), 53);
  return std::fmod(mantissa, 2) == 0 ? below : above;  // ties to even
}

}  // namespace

std::optional<double> nearest_double(const std::string& text) {
  std::string digits;
  for (char c : text)
    if (c != ' ') digits.push_back(c);
  Rational numerator, denominator;
  const std::size_t slash = digits.find('/');
  if (!read_decimal(digits.substr(0, slash), numerator)) return std::nullopt;
  if (slash != std::string::npos) {
    if (!read_decimal(digits.substr(slash + 1), denominator) || mpq_sgn(denominator.value) == 0)
      return std::nullopt;
    mpq_div(numerator.value, numerator.value, denominator.value);
  }
  const double value = rounded(numerator);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace cli
