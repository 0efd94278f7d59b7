#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace convex::inline exact_arithmetic {

/// An integer of any size. Those that fit 64 bits are held in place and computed without a call; the others
/// are GMP's.
class Integer {
 public:
  Integer(std::int64_t value = 0) : small_(value) {}  // NOLINT: an integer is one
  Integer(const Integer& other) : small_(other.small_), big_(other.big_ ? copy(other.big_) : nullptr) {}
  Integer(Integer&& other) noexcept : small_(other.small_), big_(std::exchange(other.big_, nullptr)) {}
  Integer& operator=(Integer other) noexcept {
    std::swap(small_, other.small_);
    std::swap(big_, other.big_);
    return *this;
  }
  ~Integer() {
    if (big_ != nullptr) release(big_);
  }

  /// value 2^exponent, exponent >= 0.
  static Integer shifted(std::int64_t value, unsigned long exponent);
  /// Decimal digits with an optional sign in front.
  static Integer from_digits(const std::string& digits);

  int sign() const;
  bool is_zero() const { return big_ == nullptr && small_ == 0; }
  /// Bits of |value|; 0 for 0.
  std::size_t bits() const;
  std::string text() const;

  Integer operator-() const;
  friend Integer operator+(const Integer& a, const Integer& b) {
    std::int64_t sum = 0;
    if (a.is_small(b) && !__builtin_add_overflow(a.small_, b.small_, &sum)) return sum;
    return slow_sum(a, b);
  }
  friend Integer operator-(const Integer& a, const Integer& b) {
    std::int64_t difference = 0;
    if (a.is_small(b) && !__builtin_sub_overflow(a.small_, b.small_, &difference)) return difference;
    return slow_difference(a, b);
  }
  friend Integer operator*(const Integer& a, const Integer& b) {
    std::int64_t product = 0;
    if (a.is_small(b) && !__builtin_mul_overflow(a.small_, b.small_, &product)) return product;
    return slow_product(a, b);
  }
  Integer& operator+=(const Integer& b) { return *this = *this + b; }
  Integer& operator-=(const Integer& b) { return *this = *this - b; }
  Integer& operator*=(const Integer& b) { return *this = *this * b; }

  /// a / b, b not 0 and a divisor of a.
  friend Integer exact_quotient(const Integer& a, const Integer& b);
  /// a / b, b not 0, towards 0.
  friend Integer truncated_quotient(const Integer& a, const Integer& b);
  /// a b - c d.
  friend Integer difference_of_products(const Integer& a, const Integer& b, const Integer& c,
                                        const Integer& d);
  /// Whether a / b, b not 0, leaves nothing.
  friend bool is_multiple(const Integer& a, const Integer& b);
  /// The greatest common divisor, >= 0; that of 0 and 0 is 0.
  friend Integer greatest_common_divisor(const Integer& a, const Integer& b);
  /// a / b, b > 0, rounded to nearest, ties to even; infinite when it is beyond all doubles.
  friend double nearest_quotient(const Integer& a, const Integer& b);

  friend bool operator==(const Integer& a, const Integer& b) { return compare(a, b) == 0; }
  friend std::strong_ordering operator<=>(const Integer& a, const Integer& b) { return compare(a, b) <=> 0; }

  /// The value when it fits 64 bits; used by the fast paths of exact linear algebra.
  bool fits_word() const { return big_ == nullptr; }
  std::int64_t word() const { return small_; }
  /// GMP's integer (an mpz_srcptr) when it does not; code that works on long runs of them goes through it.
  const void* gmp() const { return big_; }
  /// A copy of GMP's integer (an mpz_srcptr).
  static Integer from_gmp(const void* value);

 private:
  bool is_small(const Integer& other) const { return big_ == nullptr && other.big_ == nullptr; }
  static void* copy(const void* big);
  static void release(void* big);
  static Integer slow_sum(const Integer& a, const Integer& b);
  static Integer slow_difference(const Integer& a, const Integer& b);
  static Integer slow_product(const Integer& a, const Integer& b);
  static int compare(const Integer& a, const Integer& b);
  friend class IntegerAccess;

  std::int64_t small_ = 0;  ///< the value, when big_ is null
  void* big_ = nullptr;     ///< GMP's integer, only for what does not fit 64 bits
};

Integer exact_quotient(const Integer& a, const Integer& b);
Integer truncated_quotient(const Integer& a, const Integer& b);
Integer difference_of_products(const Integer& a, const Integer& b, const Integer& c, const Integer& d);
bool is_multiple(const Integer& a, const Integer& b);
Integer greatest_common_divisor(const Integer& a, const Integer& b);
double nearest_quotient(const Integer& a, const Integer& b);

using IntegerVector = std::vector<Integer>;
/// Integer vectors, one a row.
using IntegerRows = std::vector<IntegerVector>;

}  // namespace convex::inline exact_arithmetic
