#include "convex/piecewise/scalar_prox.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "convex/piecewise/algebra.hpp"
#include "convex/piecewise/elementary.hpp"
#include "convex/piecewise/pieces.hpp"
#include "tests/convex/piecewise/rational_pieces.hpp"

using convex::PiecewiseQuadratic;
using convex::Vector;
using oracles::Rational;
namespace piecewise = convex::piecewise;

namespace {

PiecewiseQuadratic sample(std::mt19937& generator, int seed, int largest = 7) {
  const auto given =
      oracles::rounded_pieces(generator, 1 + static_cast<int>(generator() % static_cast<unsigned>(largest)),
                              oracles::all_ends[seed % 5]);
  return convex::piecewise_quadratic(given.breaks, given.coefficients);
}

double uniform(std::mt19937& generator, double size) {
  return std::uniform_real_distribution<double>(-size, size)(generator);
}

}  // namespace

TEST_CASE("the prox is where d (z - x) is a subgradient, exactly on dyadic data") {
  std::mt19937 generator(21);
  for (int seed = 0; seed < 300; ++seed) {
    auto given = oracles::dyadic_pieces(generator, 1 + seed % 7, oracles::all_ends[seed % 5]);
    for (convex::Index i = 0; i < given.coefficients.rows(); ++i)  // c2 + d a power of two
      if (given.coefficients(i, 0) == 0.25 || given.coefficients(i, 0) == 0.5) given.coefficients(i, 0) = 1;
    PiecewiseQuadratic f = piecewise::absolute();
    try {
      f = convex::piecewise_quadratic(given.breaks, given.coefficients);
    } catch (...) {
      continue;
    }
    for (double z = -20; z <= 20; z += 0.25) {
      const double x = convex::prox(f, z, 1);
      if (x * 64 != std::floor(x * 64)) continue;  // the division was not exact
      const auto range = convex::subdifferential(f, x);
      REQUIRE(range);
      CHECK(range->low <= z - x);
      CHECK(z - x <= range->high);
    }
  }
}

TEST_CASE("no other point has a smaller f(u) + d/2 (u - z)^2, in fractions") {
  std::mt19937 generator(22);
  for (int seed = 0; seed < 200; ++seed) {
    const auto given = oracles::rounded_pieces(generator, 1 + seed % 7, oracles::all_ends[seed % 5]);
    const PiecewiseQuadratic f = convex::piecewise_quadratic(given.breaks, given.coefficients);
    const oracles::RationalPieces exact(given);
    for (int i = 0; i < 20; ++i) {
      const double z = uniform(generator, 12), d = std::exp(uniform(generator, 3));
      const double x = convex::prox(f, z, d);
      // The function is strongly convex: |x - x*|^2 d/2 is at most what x is above the infimum.
      convex::Pieces square{Vector(), convex::Matrix::Zero(1, 3)};
      square.coefficients(0, 0) = d;
      const auto least = oracles::inf_convolution_value(exact, oracles::RationalPieces(square), Rational(z));
      const auto value = exact.value(Rational(x));
      REQUIRE(least);
      REQUIRE(value);
      const Rational here =
          *value + Rational(d) / 2 * (Rational(x) - Rational(z)) * (Rational(x) - Rational(z));
      const double excess = Rational(here - *least).get_d();
      CHECK(std::sqrt(std::abs(excess) * 2 / d) <= 1e-12 * (1 + std::abs(z)) * 10);
    }
  }
}

TEST_CASE("z is the prox of f and that of the conjugate, found on two curves") {
  std::mt19937 generator(23);
  for (int seed = 0; seed < 300; ++seed) {
    const PiecewiseQuadratic f = sample(generator, seed), g = convex::conjugate(f);
    for (double size : {1e-3, 1.0, 30.0, 1e9})
      for (int i = 0; i < 10; ++i) {
        const double z = uniform(generator, size), d = std::exp(uniform(generator, 3));
        // d z = d prox(f, z, d) + prox(f*, d z, 1/d)
        const double x = convex::prox(f, z, d), y = convex::prox(g, d * z, 1 / d);
        CHECK(std::abs(d * (z - x) - y) <=
              1e-15 * 16 * (d * std::abs(z) + std::abs(y) + d * std::abs(x) + 40 + 40 * d));
        const convex::ProxPoint point = convex::prox_point(f, z, d);
        CHECK(point.x == x);
        CHECK(std::abs(point.y - y) <= 1e-15 * 16 * (d * std::abs(z) + std::abs(y) + 40 + 40 * d));
      }
  }
}

TEST_CASE("the prox is firmly nonexpansive, and its derivative the limit of difference quotients") {
  std::mt19937 generator(24);
  for (int seed = 0; seed < 200; ++seed) {
    const PiecewiseQuadratic f = sample(generator, seed);
    for (int i = 0; i < 20; ++i) {
      const double z = uniform(generator, 12), w = uniform(generator, 12),
                   d = std::exp(uniform(generator, 2));
      const double x = convex::prox(f, z, d), u = convex::prox(f, w, d);
      CHECK((x - u) * (x - u) <= (x - u) * (z - w) + 1e-12);
      const double step = 1e-6;
      const auto left = convex::prox_derivative(f, z - step, d),
                 right = convex::prox_derivative(f, z + step, d);
      const auto here = convex::prox_derivative(f, z, d);
      CHECK(here.low >= 0);
      CHECK(here.high <= 1);
      const double quotient = (convex::prox(f, z + step, d) - convex::prox(f, z - step, d)) / (2 * step);
      CHECK(quotient >= std::min({left.low, right.low, here.low}) - 1e-7);
      CHECK(quotient <= std::max({left.high, right.high, here.high}) + 1e-7);
    }
  }
  const auto kink = convex::prox_derivative(piecewise::absolute(), 1, 1);
  CHECK(kink.low == 0);
  CHECK(kink.high == 1);
}

TEST_CASE("many entries at once have the prox of each, few corners or many") {
  std::mt19937 generator(25);
  for (int seed = 0; seed < 60; ++seed) {
    const PiecewiseQuadratic f = sample(generator, seed, seed % 2 ? 4 : 30);
    const convex::Index n = 1 + 23 * seed;
    Vector z(n), d(n), x(n);
    for (convex::Index i = 0; i < n; ++i) {
      z[i] = uniform(generator, 15);
      d[i] = std::exp(uniform(generator, 3));
    }
    convex::prox(f, z, d, x);
    for (convex::Index i = 0; i < n; ++i) CHECK(x[i] == convex::prox(f, z[i], d[i]));
    convex::prox(f, z, 0.7, x);
    Vector in_place = z;
    convex::prox(f, in_place, 0.7, in_place);
    CHECK(in_place == x);
    for (convex::Index i = 0; i < n; ++i) CHECK(x[i] == convex::prox(f, z[i], 0.7));
  }
}

TEST_CASE("the prox of zero is z, of a box its projection, whatever the weight, to the last digit") {
  std::mt19937 generator(26);
  const PiecewiseQuadratic box = piecewise::indicator(-1e8, 1e8), zero = piecewise::constant(0);
  for (int i = 0; i < 1000; ++i) {
    const double z = uniform(generator, 1) * std::exp(uniform(generator, 40)),
                 d = std::exp(uniform(generator, 9));
    CHECK(convex::prox(zero, z, d) == z);
    CHECK(convex::prox(box, z, d) == std::clamp(z, -1e8, 1e8));
    CHECK(convex::prox(piecewise::point(0.1), z, d) == 0.1);
  }
  // A tiny step keeps all digits of a small result.
  CHECK(convex::prox(piecewise::quadratic(1e8), 1e8, 1) == doctest::Approx(1e8 / (1 + 1e8)).epsilon(1e-15));
}
