#include "convex/exact/grid_sum.hpp"

#include <doctest/doctest.h>

#include <random>

#include "tests/oracles/rational_elimination.hpp"

namespace {

using convex::GridSum;
using convex::GridTest;
using convex::Index;
using convex::Vector;
using oracles::Rational;

Rational exact_sum(const Vector& u, const Vector& q, double s) {
  Rational sum = -Rational(s);
  for (Index i = 0; i < q.size(); ++i) sum += Rational(u[i]) * Rational(q[i]);
  return sum;
}

/// Whole numbers of at most so many most_bits times 2^exponent.
Vector on_grid(Index n, int most_bits, int exponent, std::mt19937_64& generator) {
  Vector x(n);
  for (double& entry : x) {
    const auto whole = static_cast<double>(generator() >> (64 - most_bits));
    entry = std::ldexp((generator() & 1U) != 0 ? whole : -whole, exponent);
  }
  return x;
}

}  // namespace

TEST_CASE("a sum that is given is the exact one") {
  std::mt19937_64 generator(1966);
  int given = 0, refused = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Index n = 1 + static_cast<Index>(generator() % 12);
    const auto most_bits = [&] { return 1 + static_cast<int>(generator() % 53); };
    const auto exponent = [&] { return static_cast<int>(generator() % 400) - 200; };
    const int of_u = exponent(), of_q = exponent();
    const Vector q = on_grid(n, most_bits(), of_q, generator), u = on_grid(n, most_bits(), of_u, generator);
    const double s =
        on_grid(1, most_bits(), of_u + of_q + static_cast<int>(generator() % 9) - 4, generator)[0];
    const std::optional<double> sum = GridSum(q).value(u.data(), s);
    (sum ? given : refused) += 1;
    if (sum) CHECK((Rational(*sum) == exact_sum(u, q, s)));
  }
  CHECK(given > 1000);
  CHECK(refused > 1000);
}

TEST_CASE("sums of sixteenths are given, thirds times thirds are not") {
  const Vector q{{-1.5, 0.0625, 2}}, u{{0.25, -3, 0.125}};
  const std::optional<double> sum = GridSum(q).value(u.data(), 0.5);
  REQUIRE(sum.has_value());
  CHECK(*sum == -0.8125);
  const Vector third{{1.0 / 3, 1.0 / 3}};
  CHECK_FALSE(GridSum(third).value(third.data(), 0).has_value());
}

TEST_CASE("a point of zeros and rows of zeros leave the bound alone") {
  const Vector zero = Vector::Zero(3), u{{0.1, -0.3, 1e300}};
  CHECK(*GridSum(zero).value(u.data(), 0.7) == -0.7);
  const Vector q{{0.5, 2, 0}};
  CHECK(*GridSum(q).value(zero.data(), -2) == 2);
}

TEST_CASE("sums over rows on grids, as doubles make them in any order, are exact where that is said") {
  std::mt19937_64 generator(1958);
  int told = 0, refused = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Index n = 1 + static_cast<Index>(generator() % 12);
    const auto most_bits = [&] { return 1 + static_cast<int>(generator() % 30); };
    const Vector rows = on_grid(5 * n, most_bits(), -20, generator);
    GridTest test(rows.size(), rows.data());
    for (int point = 0; point < 3; ++point) {  // what is remembered of the rows serves the next point
      const Vector q = on_grid(n, most_bits(), static_cast<int>(generator() % 40), generator);
      const double s = on_grid(1, most_bits(), -20 + static_cast<int>(generator() % 40), generator)[0];
      const std::optional<double> step = GridSum(q).step_of_sums(test);
      const bool is_exact = step && convex::is_on_grid(s, *step);
      (is_exact ? told : refused) += 1;
      for (Index a = 0; a < 5 && is_exact; ++a) {
        double up = 0, down = 0;
        for (Index i = 0; i < n; ++i) up += rows[a * n + i] * q[i];
        for (Index i = n; i-- > 0;) down += rows[a * n + i] * q[i];
        CHECK((Rational(up - s) == exact_sum(rows.segment(a * n, n), q, s)));
        CHECK(up == down);
      }
    }
  }
  CHECK(told > 1000);
  CHECK(refused > 1000);
}

TEST_CASE(
    "numbers lie on the grids finer than one that they lie on, and on none coarser than one that they do "
    "not") {
  const Vector x{{1.25, -3, 0.5}};
  GridTest first(3, x.data());
  for (const double step : {0.25, 0.125, 0x1p-40, 0.25}) CHECK(first.is_on(step));
  for (const double step : {0.5, 1.0, 0x1p-60, 0.5, 4.0}) CHECK_FALSE(first.is_on(step));
  CHECK(first.largest() == 3);
}
