#include "convex/atlas/orthant_probability.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "convex/atlas/proved_integral.hpp"
#include "convex/interval_arithmetic.hpp"

using namespace convex;
using namespace convex::atlas;

namespace {

NormalVariables equally_correlated(Index k, double correlation, double mean) {
  NormalVariables of{Vector::Constant(k, mean), Matrix::Constant(k, k, std::acos(correlation))};
  of.angles.diagonal().setZero();
  return of;
}

double below_bound(double x) { return std::erfc(-x / std::numbers::sqrt2) / 2; }

/// Variables sqrt(rho) T + sqrt(1 - rho) Z_i: given T they are independent (Dunnett and Sobel 1955).
double by_conditioning(Index k, double correlation, double mean) {
  const auto integrand = [&](double t) {
    const double one = below_bound((mean + std::sqrt(correlation) * t) / std::sqrt(1 - correlation));
    return std::exp(-t * t / 2) / std::sqrt(2 * std::numbers::pi) * std::pow(one, static_cast<double>(k));
  };
  // The trapezoidal rule of a function that is analytic about the line (Trefethen and Weideman 2014).
  constexpr double step = 1.0 / 512;
  double sum = 0;
  for (int j = -9 * 512; j <= 9 * 512; ++j) sum += integrand(j * step);
  return step * sum;
}

}  // namespace

TEST_CASE("of k + 1 equal independent variables each is the largest with the probability 1/(k + 1)") {
  // X_i = Z_0 - Z_i are correlated by 1/2.
  for (Index k = 1; k <= most_variables; ++k) {
    const Probability p = orthant_probability(equally_correlated(k, 0.5, 0), 1e-9);
    CAPTURE(k);
    CHECK(std::abs(p.value - 1.0 / static_cast<double>(k + 1)) <= p.error + 1e-14);
    CHECK(p.error <= 1e-9);
    CHECK(p.closed == (k <= 3));
  }
}

TEST_CASE("the probability of an orthant agrees with conditioning on a common cause, within its bound") {
  for (Index k = 1; k <= most_variables; ++k)
    for (const double correlation : {0.1, 0.6, 0.95, 0.999})
      for (const double mean : {-2.5, -0.3, 0.0, 1.7}) {
        const Probability p = orthant_probability(equally_correlated(k, correlation, mean), 1e-8);
        CAPTURE(k);
        CAPTURE(correlation);
        CAPTURE(mean);
        CHECK(std::abs(p.value - by_conditioning(k, correlation, mean)) <= p.error + 1e-12);
        CHECK(p.error <= 1e-8);
      }
}

TEST_CASE("a thin cone has its angle to the last digits, where the correlation is 1 to rounding") {
  NormalVariables of{Vector::Zero(2), Matrix::Zero(2, 2)};
  const double thin = 1e-9;
  of.angles(0, 1) = of.angles(1, 0) = std::numbers::pi - thin;
  const Probability p = orthant_probability(of, 1e-6);
  CHECK(p.value == doctest::Approx(thin / (2 * std::numbers::pi)).epsilon(1e-6));
}

TEST_CASE("variables of two independent groups have the product of the groups' probabilities") {
  NormalVariables of{Vector(5), Matrix::Constant(5, 5, std::numbers::pi / 2)};
  of.mean << 0.4, -1, 0.7, 0.2, -0.1;
  of.angles(0, 1) = of.angles(1, 0) = 2.1;
  of.angles(2, 3) = of.angles(3, 2) = of.angles(2, 4) = of.angles(4, 2) = 1.2;
  of.angles(3, 4) = of.angles(4, 3) = 0.9;
  const auto part = [&](const std::vector<Index>& chosen) {
    const auto size = static_cast<Index>(chosen.size());
    NormalVariables some{Vector(size), Matrix(size, size)};
    for (Index i = 0; i < size; ++i) {
      some.mean[i] = of.mean[chosen[static_cast<std::size_t>(i)]];
      for (Index j = 0; j < size; ++j)
        some.angles(i, j) =
            of.angles(chosen[static_cast<std::size_t>(i)], chosen[static_cast<std::size_t>(j)]);
    }
    return orthant_probability(some, 1e-10);
  };
  const Probability whole = orthant_probability(of, 1e-9), product = part({0, 1}) * part({2, 3, 4});
  CHECK(std::abs(whole.value - product.value) <= whole.error + product.error);
}

TEST_CASE("an integral lies in its enclosure, and a size bound that is too small is what that rests on") {
  // 1/(2 - x) from 0 to 1 is log 2; its pole is at 2.
  const auto size = [](double factor) {
    return [factor](const Interval& u, const Interval&) {
      return u.high < 2 ? factor / (2 - u.high) : std::numeric_limits<double>::infinity();
    };
  };
  const auto at = [](const Interval& x) { return interval_at(1) / (interval_at(2) - x); };
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-13}) {
    const Interval found = proved_integral({at, size(1), {0.5, 1}, 2}, 1, tolerance);
    CAPTURE(tolerance);
    CHECK(found.low <= std::log(2.0));
    CHECK(std::log(2.0) <= found.high);
    CHECK(found.high - found.low <= 2 * tolerance);
  }
  const Interval wrong = proved_integral({at, size(1e-9), {0.5, 1}, 2}, 1, 1e-9);
  CHECK_FALSE((wrong.low <= std::log(2.0) && std::log(2.0) <= wrong.high));
  // Without a place for ellipses all is halved, up to a limit; what comes out is wide, and right.
  const Interval wide = proved_integral({at, size(1), {0.5, 1}, 0}, 1, 1e-9);
  CHECK((wide.low <= std::log(2.0) && std::log(2.0) <= wide.high));
}

TEST_CASE("bounds hold at tolerances that invite few points, for correlations of either sign") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 40; ++trial) {
    const Index k = 2 + trial % 4;
    const Matrix B = Matrix::NullaryExpr(k, k, [&] { return normal(random); });
    const Matrix V = B * B.transpose() + (trial % 3 == 0 ? 0.01 : 0.5) * Matrix::Identity(k, k);
    NormalVariables of{Vector::NullaryExpr(k, [&] { return normal(random); }), Matrix::Zero(k, k)};
    if (trial % 2 == 0) of.mean.setZero();
    for (Index i = 0; i < k; ++i)
      for (Index j = 0; j < k; ++j)
        if (i != j) of.angles(i, j) = std::acos(V(i, j) / std::sqrt(V(i, i) * V(j, j)));
    const Probability fine = orthant_probability(of, 1e-11);
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6}) {
      const Probability coarse = orthant_probability(of, tolerance);
      CAPTURE(trial);
      CHECK(coarse.error <= tolerance);
      CHECK(std::abs(coarse.value - fine.value) <= coarse.error + fine.error);
    }
  }
}
