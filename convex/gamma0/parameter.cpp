#include "convex/gamma0/parameter.hpp"

#include <cmath>
#include <string>

#include "convex/invalid_input.hpp"

namespace convex::inline gamma0 {
namespace {

[[noreturn]] void refuse(const char* maker, const char* parameter, const char* what) {
  throw InvalidInput(std::string(maker) + "(" + parameter + "): " + what);
}

}  // namespace

void require_finite(const char* maker, const char* parameter, double number) {
  if (!std::isfinite(number)) refuse(maker, parameter, "not finite; give a number");
}

void require_finite(const char* maker, const char* parameter, const Vector& numbers) {
  if (!numbers.allFinite()) refuse(maker, parameter, "an entry is not finite; give numbers");
}

void require_finite(const char* maker, const char* parameter, const Matrix& numbers) {
  if (!numbers.allFinite()) refuse(maker, parameter, "an entry is not finite; give numbers");
}

void require_entries(const char* maker, const char* parameter, const Vector& numbers) {
  if (numbers.size() == 0) refuse(maker, parameter, "no entries; give at least one");
  require_finite(maker, parameter, numbers);
}

void require_nonnegative(const char* maker, const char* parameter, const Vector& numbers) {
  require_entries(maker, parameter, numbers);
  if (numbers.minCoeff() < 0) refuse(maker, parameter, "an entry is negative; give 0 or more");
}

void require_nonnegative(const char* maker, const char* parameter, double number) {
  require_finite(maker, parameter, number);
  if (number < 0) refuse(maker, parameter, "negative; give 0 or more");
}

void require_square(const std::string& maker, Index n) {
  const Index order = static_cast<Index>(std::llround(std::sqrt(static_cast<double>(n))));
  if (order * order != n)
    throw InvalidInput(maker + ": " + std::to_string(n) +
                       " entries are no square matrix stacked by columns; give n*n");
}

void require_positive(const char* maker, const char* parameter, double number) {
  require_finite(maker, parameter, number);
  if (number <= 0) refuse(maker, parameter, "not positive; give more than 0");
}

}  // namespace convex::inline gamma0
