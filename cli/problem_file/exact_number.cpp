#include "cli/problem_file/exact_number.hpp"

#include <gmp.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

namespace cli {
namespace {

/// A decimal exponent beyond this (and the digits written) is read as this: the value is beyond all doubles,
/// or 0, either way, and its digits would fill the memory.
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
  const long farthest = largest_exponent + static_cast<long>(text.size());
  long exponent = 0;
  if (const std::size_t e = text.find_first_of("eE"); e != std::string::npos) {
    const char* first = text.data() + e + 1;
    const char* last = text.data() + text.size();
    if (first != last && *first == '+') ++first;
    const auto [end, error] = std::from_chars(first, last, exponent);
    if (end != last || error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range) exponent = *first == '-' ? -farthest : farthest;
    exponent = std::clamp(exponent, -farthest, farthest);
    text.resize(e);
  }
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.erase(0, 1);
  if (const std::size_t point = text.find('.'); point != std::string::npos) {
    exponent -= static_cast<long>(text.size() - point - 1);
    text.erase(point, 1);
  }
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos) return false;
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
  if (!std::isfinite(below) ||
      mpz_sizeinbase(mpq_numref(exact.value), 2) > 1024 + mpz_sizeinbase(mpq_denref(exact.value), 2))
    return mpq_sgn(exact.value) * INFINITY;
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
  const auto trimmed = [](const std::string& part) {
    const std::size_t first = part.find_first_not_of(' ');
    return first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(' ') - first + 1);
  };
  Rational numerator, denominator;
  const std::size_t slash = text.find('/');
  if (!read_decimal(trimmed(text.substr(0, slash)), numerator)) return std::nullopt;
  if (slash != std::string::npos) {
    if (!read_decimal(trimmed(text.substr(slash + 1)), denominator) || mpq_sgn(denominator.value) == 0)
      return std::nullopt;
    mpq_div(numerator.value, numerator.value, denominator.value);
  }
  const double value = rounded(numerator);
  return value;
}

}  // namespace cli
