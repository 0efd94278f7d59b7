#include "convex/exact/exact_sum.hpp"

#include <cmath>

#include "convex/exact/fraction_arithmetic.hpp"

namespace convex::inline exact_arithmetic {
namespace {

/// Products of sizes in between are exact as pairs of doubles; Veltkamp's split overflows above.
constexpr double smallest_product = 0x1p-960, largest_factor = 0x1p480;

Fraction sum(const Fraction& a, double b) { return a + fraction(b); }

}  // namespace

/// Whether the three doubles can hold the term too; they are changed only then.
bool ExactSum::take(double term) {
  const DoubleDouble first = two_sum(high_, term), second = two_sum(middle_, first.lo),
                     third = two_sum(low_, second.lo);
  if (third.lo != 0 || !std::isfinite(first.hi)) return false;
  high_ = first.hi;
  middle_ = second.hi;
  low_ = third.hi;
  return true;
}

void ExactSum::spill() {
  if (is_fraction_) return;
  is_fraction_ = true;
  sum_ = sum(sum(fraction(high_), middle_), low_);
}

void ExactSum::add(double term) {
  if (!is_fraction_ && take(term)) return;
  spill();
  sum_ = sum(sum_, term);
}

void ExactSum::add_product(double x, double y) {
  if (x == 0 || y == 0) return;
  const bool ordinary =
      std::abs(x) <= largest_factor && std::abs(y) <= largest_factor && std::abs(x * y) >= smallest_product;
  if (ordinary && !is_fraction_) {
    const DoubleDouble product = two_product(x, y);
    if (take(product.hi)) {
      add(product.lo);
      return;
    }
  }
  spill();
  sum_ = sum_ + fraction(x) * fraction(y);
}

double ExactSum::value() const {
  if (is_fraction_) return nearest_double(sum_);
  // Three passes of two_sum leave parts that do not overlap; the first one then has the sign of all.
  DoubleDouble front = two_sum(high_, middle_), back = two_sum(front.lo, low_);
  for (int pass = 0; pass < 2; ++pass) {
    front = two_sum(front.hi, back.hi);
    back = two_sum(front.lo, back.lo);
  }
  return front.hi != 0 ? front.hi : back.hi + back.lo;
}

int ExactSum::sign() const {
  if (is_fraction_) return convex::sign(sum_);
  const double x = value();
  return (x > 0) - (x < 0);
}

}  // namespace convex::inline exact_arithmetic
