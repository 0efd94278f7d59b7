#include "convex/exact/grid_sum.hpp"

#include <doctest/doctest.h>

#include <random>

#include "tests/oracles/rational_elimination.hpp"

namespace {

using convex::GridSum;
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
