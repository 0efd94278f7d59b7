#include <doctest/doctest.h>

#include <cmath>

#include "convex/proved_prox/proved_conjugate.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Function;
using convex::Index;
using convex::Metric;
using convex::Value;
using convex::Vector;

namespace {

/// log Σ e^(y_i), the conjugate of Σ x_i log x_i on the simplex.
double log_sum_of_powers(const Vector& y) {
  const double highest = y.maxCoeff();
  return highest + std::log((y.array() - highest).exp().sum());
}

/// Entries that spread over `spread` on both sides of 0, some of them near it.
Vector spread_out(Index n, double spread, Index shift) {
  Vector y(n);
  for (Index i = 0; i < n; ++i) {
    const double part = std::sin(static_cast<double>(7 * i + 3 * shift + 1));
    y[i] = spread * part * ((i + shift) % 3 == 0 ? 1 : (i + shift) % 3 == 1 ? 0.1 : 0.01);
  }
  return y;
}

}  // namespace

TEST_CASE(
    "the conjugate of the entropy on the simplex is the logarithm of the sum of powers, however small") {
  for (const Index n : {2, 3, 5, 10, 20, 40, 50}) {
    const Metric plain = Metric::identity(n);
    const Function g = samples::function("sum(entropy(), indicator(simplex(1)))", plain).conjugate();
    for (const double spread : {1.0, 10.0, 35.0, 100.0})
      for (Index shift = 0; shift < 2; ++shift) {
        const Vector y = spread_out(n, spread, shift);
        const Value found = convex::decided_value(g, plain, y);
        const double size = std::max(1.0, std::abs(found.value));
        CAPTURE(n);
        CAPTURE(spread);
        CAPTURE(shift);
        CHECK(std::abs(found.value - log_sum_of_powers(y)) <= found.error + 1e-15 * size);
        CHECK(found.error <= (n <= 10 ? 1e-9 : 1e-6) * size);  // of more entries it is an honest bound
      }
  }
}

TEST_CASE("a value that nothing tells from 0 has an error that counts it") {
  const Metric plain = Metric::identity(2);
  const Function g = samples::function("sum(entropy(), indicator(simplex(1)))", plain).conjugate();
  for (const double low : {-30.0, -35.0, -36.0, -40.0}) {
    const Value found = convex::decided_value(g, plain, Vector{{0, low}});
    CHECK(std::abs(found.value - std::exp(low)) <= found.error);
    CHECK(found.error <= 1e-12);
  }
}
