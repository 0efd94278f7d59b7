#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "mechanics/motion/arc.hpp"
#include "mechanics/motion/terms.hpp"

using convex::Index;
using convex::Vector;

namespace {

/// Coefficients that shrink as those of a series do, `zeros` of them 0 at the end.
std::vector<double> series(Index count, Index zeros, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> draw(-1, 1);
  std::vector<double> c(static_cast<std::size_t>(count));
  for (Index k = 0; k < count - zeros; ++k)
    c[static_cast<std::size_t>(k)] = draw(generator) * std::pow(2.0, k);
  return c;
}

}  // namespace

TEST_CASE("state and acceleration on an arc are those of its polynomials, of any number of coefficients") {
  constexpr double tau = 0.21;
  for (Index count = 3; count < 64; ++count)
    for (const Index zeros : {Index{0}, count / 2}) {
      CAPTURE(count);
      CAPTURE(zeros);
      mechanics::Arc arc;
      arc.q.resize(2, count);
      for (Index i = 0; i < 2; ++i) {
        const std::vector<double> c = series(count, i * zeros, static_cast<unsigned>(10 * count + i));
        std::copy(c.begin(), c.end(), arc.q.data() + i * count);
      }
      mechanics::State at;
      Vector q2;
      arc.state(tau, at, q2);
      for (Index i = 0; i < 2; ++i) {
        long double value = 0, slope = 0, second = 0, size = 0;
        for (Index k = 0; k < count; ++k) {
          const long double c = arc.q(i, k), n = k;
          value += c * std::pow(static_cast<long double>(tau), n);
          if (k > 0) slope += n * c * std::pow(static_cast<long double>(tau), n - 1);
          if (k > 1) second += n * (n - 1) * c * std::pow(static_cast<long double>(tau), n - 2);
          size += n * n * std::abs(c) * std::pow(static_cast<long double>(tau), std::max(n - 2, 0.0L));
        }
        const auto bound = static_cast<double>(1e-15L * (size + std::abs(arc.q(i, 0))));
        CHECK(std::abs(at.q[i] - static_cast<double>(value)) <= bound);
        CHECK(std::abs(at.v[i] - static_cast<double>(slope)) <= bound);
        CHECK(std::abs(q2[i] - static_cast<double>(second)) <= bound);
      }
    }
}

TEST_CASE("terms are summed and compared by their sizes from the first power on") {
  for (Index count = 0; count < 64; ++count) {
    CAPTURE(count);
    const std::vector<double> c = series(count, 0, static_cast<unsigned>(count));
    constexpr double h = 0.45;
    double sum = 0, most = 0;
    for (std::size_t k = 1; k < c.size(); ++k) {
      const double term = std::abs(c[k]) * std::pow(h, static_cast<double>(k));
      sum += term;
      most = std::max(most, term);
    }
    CHECK(mechanics::sum_of_terms(c, h) == doctest::Approx(sum).epsilon(1e-14));
    CHECK(mechanics::largest_term(c, h) == doctest::Approx(most).epsilon(1e-14));
  }
}
