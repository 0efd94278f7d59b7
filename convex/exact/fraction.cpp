#include "convex/exact/fraction.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "convex/invalid_input.hpp"

namespace convex::inline exact_arithmetic {
namespace {

constexpr long largest_exponent = 5000;

Integer power_of_ten(long exponent) {
  return Integer::from_digits("1" + std::string(static_cast<std::size_t>(exponent), '0'));
}

/// [+-]digits[.digits][e[+-]digits]
std::optional<Fraction> read_decimal(std::string text) {
  const long farthest = largest_exponent + static_cast<long>(text.size());
  long exponent = 0;
  if (const std::size_t e = text.find_first_of("eE"); e != std::string::npos) {
    const char* first = text.data() + e + 1;
    const char* last = text.data() + text.size();
    if (first != last && *first == '+') ++first;
    const auto [end, error] = std::from_chars(first, last, exponent);
    if (end != last || error == std::errc::invalid_argument) return std::nullopt;
    if (error == std::errc::result_out_of_range) exponent = *first == '-' ? -farthest : farthest;
    exponent = std::clamp(exponent, -farthest, farthest);
    text.resize(e);
  }
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.erase(0, 1);
  if (const std::size_t point = text.find('.'); point != std::string::npos) {
    exponent -= static_cast<long>(text.size() - point - 1);
    text.erase(point, 1);
  }
  if (text.empty() || text.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  Fraction value{Integer::from_digits(text), 1};
  if (negative) value.numerator = -value.numerator;
  if (exponent > 0) value.numerator *= power_of_ten(exponent);
  if (exponent < 0) value.denominator = power_of_ten(-exponent);
  return value;
}

std::string trimmed(const std::string& part) {
  const std::size_t first = part.find_first_not_of(' ');
  return first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(' ') - first + 1);
}

}  // namespace

std::optional<Fraction> read_fraction(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto numerator = read_decimal(trimmed(text.substr(0, slash)));
  if (!numerator || slash == std::string::npos) return numerator;
  const auto denominator = read_decimal(trimmed(text.substr(slash + 1)));
  if (!denominator || denominator->numerator.is_zero()) return std::nullopt;
  Fraction value{numerator->numerator * denominator->denominator,
                 numerator->denominator * denominator->numerator};
  if (value.denominator.sign() < 0) value = {-value.numerator, -value.denominator};
  return value;
}

Fraction fraction(double value) {
  int exponent = 0;
  constexpr int digits = 53;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
  exponent -= digits;
  if (mantissa == 0) return {0, 1};
  if (exponent >= 0) return {Integer::shifted(mantissa, static_cast<unsigned long>(exponent)), 1};
  return {mantissa, Integer::shifted(1, static_cast<unsigned long>(-exponent))};
}

double nearest_double(const Fraction& value) { return nearest_quotient(value.numerator, value.denominator); }

ExactVector exact_vector(const std::vector<Fraction>& entries) {
  ExactVector x;
  for (const Fraction& entry : entries) {
    const Integer common = greatest_common_divisor(x.denominator, entry.denominator);
    x.denominator *= exact_quotient(entry.denominator, common);
  }
  Integer factor = x.denominator;
  for (const Fraction& entry : entries) {
    x.numerators.push_back(entry.numerator * exact_quotient(x.denominator, entry.denominator));
    factor = greatest_common_divisor(factor, x.numerators.back());
  }
  x.denominator = exact_quotient(x.denominator, factor);
  for (Integer& numerator : x.numerators) numerator = exact_quotient(numerator, factor);
  return x;
}

ExactVector exact_vector(const Vector& x) {
  std::vector<Fraction> entries;
  for (Index i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]))
      throw InvalidInput("entry " + std::to_string(i) + ": not finite; give finite numbers");
    entries.push_back(fraction(x[i]));
  }
  return exact_vector(entries);
}

Vector nearest(const ExactVector& x) {
  Vector rounded(x.size());
  for (Index i = 0; i < x.size(); ++i)
    rounded[i] = nearest_quotient(x.numerators[static_cast<std::size_t>(i)], x.denominator);
  return rounded;
}

DoubleDouble nearest_pair(const Fraction& value) {
  const double hi = nearest_double(value);
  const Fraction taken = fraction(hi);
  return {hi, nearest_double({value.numerator * taken.denominator - taken.numerator * value.denominator,
                              value.denominator * taken.denominator})};
}

DoubleDoubleVector nearest_pairs(const ExactVector& x) {
  DoubleDoubleVector pairs(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const DoubleDouble pair = nearest_pair({x.numerators[static_cast<std::size_t>(i)], x.denominator});
    pairs.hi[i] = pair.hi;
    pairs.lo[i] = pair.lo;
  }
  return pairs;
}

ExactRows exact_rows(const Matrix& M) {
  ExactRows rows;
  for (Index i = 0; i < M.rows(); ++i) rows.push_back(exact_vector(Vector(M.row(i))));
  return rows;
}

IntegerMatrix over_one_denominator(const ExactRows& rows) {
  IntegerMatrix M;
  for (const ExactVector& row : rows)
    M.denominator *= exact_quotient(row.denominator, greatest_common_divisor(row.denominator, M.denominator));
  for (const ExactVector& row : rows) {
    M.rows.push_back(row.numerators);
    for (Integer& entry : M.rows.back()) entry *= exact_quotient(M.denominator, row.denominator);
  }
  return M;
}

void make_primitive(IntegerVector& v) {
  Integer factor = 0;
  for (const Integer& entry : v) {
    factor = greatest_common_divisor(factor, entry);
    if (factor == 1) return;
  }
  if (!factor.is_zero())
    for (Integer& entry : v) entry = exact_quotient(entry, factor);
}

}  // namespace convex::inline exact_arithmetic
