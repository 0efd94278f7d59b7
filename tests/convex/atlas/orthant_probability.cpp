#include "convex/atlas/orthant_probability.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "convex/atlas/quadrature.hpp"

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
  double sum = 0;
  for (double from = -9; from < 9; from += 0.5) sum += integral(integrand, from, from + 0.5, 1e-16).value;
  return sum;
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
