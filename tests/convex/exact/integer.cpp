#include "convex/exact/integer.hpp"
#include "convex/exact/elimination.hpp"

#include <doctest/doctest.h>
#include <gmpxx.h>

#include <cmath>
#include <limits>
#include <random>

#include "convex/exact/fraction.hpp"

using convex::Integer;

namespace {

mpz_class gmp(const Integer& a) { return mpz_class(a.text()); }
std::string digits(const mpz_class& a) { return a.get_str(); }

/// Around 0, around the ends of 64 bits, and far beyond.
std::vector<Integer> samples() {
  std::vector<Integer> found;
  for (std::int64_t base : {std::int64_t{0}, std::numeric_limits<std::int64_t>::max() - 1,
                            std::numeric_limits<std::int64_t>::min() + 1, std::int64_t{3037000500}})
    for (std::int64_t step : {-1, 0, 1}) found.emplace_back(base + step);
  for (const char* digits : {"9223372036854775808", "-9223372036854775809", "1000000000000000000000000000",
                             "-340282366920938463463374607431768211456"})
    found.push_back(Integer::from_digits(digits));
  return found;
}

}  // namespace

TEST_CASE("integers add, multiply, compare and print as those of GMP, on both sides of 64 bits") {
  for (const Integer& a : samples())
    for (const Integer& b : samples()) {
      CAPTURE(a.text());
      CAPTURE(b.text());
      CHECK((a + b).text() == digits(gmp(a) + gmp(b)));
      CHECK((a - b).text() == digits(gmp(a) - gmp(b)));
      CHECK((a * b).text() == digits(gmp(a) * gmp(b)));
      CHECK((a < b) == (gmp(a) < gmp(b)));
      CHECK((a == b) == (gmp(a) == gmp(b)));
      CHECK((a + b).fits_word() == mpz_class(gmp(a) + gmp(b)).fits_slong_p());
      CHECK(greatest_common_divisor(a, b).text() == digits(gcd(gmp(a), gmp(b))));
      for (const Integer& c : {a, Integer(3), a * b}) {
        CHECK(difference_of_products(a, b, c, b).text() == digits(gmp(a) * gmp(b) - gmp(c) * gmp(b)));
        CHECK(difference_of_products(a, b, b, a).is_zero());
      }
      if (b.is_zero()) continue;
      CHECK(exact_quotient(a * b, b).text() == a.text());
      CHECK(is_multiple(a * b, b));
      CHECK(is_multiple(a, b) == (gmp(a) % gmp(b) == 0));
    }
}

TEST_CASE("a quotient is rounded to the nearest double, ties to even, down to the smallest") {
  std::mt19937_64 generator(3);
  for (int trial = 0; trial < 2000; ++trial) {
    // A double times b, give or take less than half a place times b: the double must come back.
    const double x =
        std::ldexp(static_cast<double>(generator() >> 11U), static_cast<int>(generator() % 2000) - 1100);
    if (!std::isfinite(x) || std::abs(x) < std::numeric_limits<double>::min()) continue;
    const convex::Fraction exact = convex::fraction(x);
    const Integer scale =
        Integer::shifted(1, 60) * Integer(static_cast<std::int64_t>(generator() >> 40U) + 1);
    const Integer numerator = exact.numerator * scale, denominator = exact.denominator * scale;
    CHECK(convex::nearest_quotient(numerator, denominator) == x);
    CHECK(convex::nearest_quotient(-numerator - 1, denominator) == -x);
  }
  const Integer odd = Integer::shifted(1, 53) + 1, next = Integer::shifted(1, 53) + 3;
  CHECK(convex::nearest_quotient(odd, 1) == 0x1p53);
  CHECK(convex::nearest_quotient(next, 1) == 0x1p53 + 4);
  CHECK(convex::nearest_quotient(-odd * 1024 - 1, 1024) == -0x1p53 - 2);
  CHECK(convex::nearest_quotient(1, Integer::shifted(1, 1075)) == 0);  // half of the smallest: to even
  CHECK(convex::nearest_quotient(3, Integer::shifted(1, 1076)) == 0x1p-1074);
  CHECK(convex::nearest_quotient(3, Integer::shifted(1, 1075)) == 0x1p-1073);
  CHECK(convex::nearest_quotient(1, 3) == 1.0 / 3);
  CHECK(convex::nearest_quotient(Integer::shifted(1, 1024), 1) == std::numeric_limits<double>::infinity());
  CHECK(convex::nearest_quotient(Integer::shifted(1, 1024) - 1, 1) ==
        std::numeric_limits<double>::infinity());
  CHECK(convex::nearest_quotient(Integer::shifted(-1, 2000), Integer::shifted(1, 1999)) == -2);
}

TEST_CASE("a sum of products is the same by words, by two words and term by term") {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max(),
                         least = std::numeric_limits<std::int64_t>::min();
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 2000; ++trial) {
    convex::IntegerVector a, b;
    for (int k = 0; k < 12; ++k) {
      const auto draw = [&]() -> convex::Integer {
        switch (random() % 6) {
          case 0:
            return most;
          case 1:
            return least;
          case 2:
            return trial % 2 == 0 ? convex::Integer(3) : convex::Integer::shifted(least, random() % 80);
          default:
            return static_cast<std::int64_t>(random());
        }
      };
      a.push_back(draw());
      b.push_back(draw());
    }
    convex::Integer sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    CHECK(convex::dot(a, b) == sum);
  }
}
