// The nuclear norm of matrices far from 0, of full rank: its only subgradient is the polar factor, so that x
// is where x = z - W⁻¹ polar(x). The polar factor comes from Newton's iteration (Higham 1986), in long
// double.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>

#include "convex/functions/decomposition.hpp"
#include "convex/functions/norms.hpp"

using namespace convex;

namespace {

using Entries = std::array<long double, 9>;  // of a 3x3 matrix, by columns

long double determinant_with(const Entries& a, const Entries& cofactors) {
  return a[0] * cofactors[0] + a[1] * cofactors[1] + a[2] * cofactors[2];
}

Entries cofactors_of(const Entries& a) {
  Entries c;
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](std::size_t row, std::size_t column) { return a[column % 3 * 3 + row % 3]; };
      c[j * 3 + i] = at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1);
    }
  return c;
}

Entries inverse_transposed(const Entries& a) {
  Entries c = cofactors_of(a);
  const long double determinant = determinant_with(a, c);
  for (long double& entry : c) entry /= determinant;
  return c;
}

Entries polar_factor(Entries a) {
  for (int step = 0; step < 60; ++step) {
    const Entries b = inverse_transposed(a);
    for (std::size_t i = 0; i < 9; ++i) a[i] = (a[i] + b[i]) / 2;
  }
  return a;
}

}  // namespace

TEST_CASE(
    "the bound of a nuclear norm's prox counts the rounding of singular vectors, however far the matrix") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (const double size : {1e2, 1e5, 1e8})
    for (int k = 0; k < 300; ++k) {
      Vector z(9), d(9);
      for (Index i = 0; i < 9; ++i) {
        z[i] = size * normal(random);
        d[i] = std::ldexp(1 + std::abs(normal(random)), static_cast<int>(random() % 7) - 3);
      }
      Entries x, y{};
      for (std::size_t i = 0; i < 9; ++i) x[i] = z[static_cast<Index>(i)];
      if (std::abs(determinant_with(x, cofactors_of(x))) < 0.1L * size * size * size) continue;
      for (int step = 0; step < 60; ++step) {
        for (std::size_t i = 0; i < 9; ++i) x[i] = z[static_cast<Index>(i)] - y[i];
        y = polar_factor(x);
        for (std::size_t i = 0; i < 9; ++i) y[i] /= d[static_cast<Index>(i)];
      }
      const Metric W = Metric::diagonal(d);
      const Function f = nuclear_norm(1, 3);
      const auto distance = [&](const Vector& found, const Entries& exact) {
        long double square = 0;
        for (Index i = 0; i < 9; ++i) {
          const long double off = found[i] - exact[static_cast<std::size_t>(i)];
          square += d[i] * off * off;
        }
        return static_cast<double>(std::sqrt(square));
      };
      const Prox found = f.prox(z, W);
      CHECK(distance(found.x, x) <= found.error_bound);
      CHECK(found.error_bound <= 1e-13 * W.norm(z));
      if (k % 10 != 0) continue;
      const Decomposition split = decompose(f, z, W);
      CHECK(distance(split.x.x, x) <= split.error_bound * (1 + 1e-9));
      CHECK(distance(split.y.x, y) <= split.error_bound * (1 + 1e-9));
    }
}
