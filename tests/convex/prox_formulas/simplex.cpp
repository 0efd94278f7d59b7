#include "convex/prox_formulas/simplex.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/capped_simplex.hpp"
#include "tests/convex/prox_formulas/rational_level.hpp"

using convex::Index;
using convex::Vector;
using oracles::Rational;
using oracles::RationalVector;
namespace k = convex::prox_formulas;

namespace {

constexpr double few = 8 * convex::unit_roundoff;

struct Sample {
  Vector z, d;
};

/// Points with many ties and zeros, Gaussian points, points far away, points of all scales; n from 1. The
/// last in metrics whose weights are far apart.
std::vector<Sample> samples() {
  std::vector<Sample> found;
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  for (int kind = 0; kind < 6; ++kind)
    for (Index n : {1, 2, 3, 5, 9, 17, 40}) {
      Sample s{Vector(n), Vector(n)};
      for (Index i = 0; i < n; ++i) {
        const double tie = static_cast<double>(generator() % 5) - 2;
        s.z[i] = kind == 0   ? tie
                 : kind == 1 ? normal(generator)
                 : kind == 2 ? 1e9 + tie / 4
                 : kind == 3 ? std::ldexp(normal(generator), 10 * static_cast<int>(generator() % 5) - 20)
                             : -1e6 * std::abs(normal(generator));
        s.d[i] = kind == 0   ? static_cast<double>(1 + generator() % 3)
                 : kind == 5 ? std::ldexp(1 + normal(generator) / 16, -static_cast<int>(generator() % 60))
                             : std::exp(2 * normal(generator));
      }
      found.push_back(s);
    }
  return found;
}

RationalVector ones(Index n) { return RationalVector(static_cast<std::size_t>(n), Rational(1)); }

RationalVector inverse(RationalVector d) {
  for (Rational& v : d) v = 1 / v;
  return d;
}

RationalVector product(RationalVector a, const RationalVector& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] *= b[i];
  return a;
}

RationalVector absolute(RationalVector a) {
  for (Rational& v : a) v = abs(v);
  return a;
}

/// clamp(z - level/d, 0, cap) with sum `total`.
RationalVector exact_capped(const RationalVector& z, const RationalVector& d, const Rational& cap,
                            const Rational& total) {
  const Rational level = oracles::level_of_height(product(z, d), inverse(d), cap, total);
  RationalVector x;
  for (std::size_t i = 0; i < z.size(); ++i) {
    x.push_back(std::max(Rational(0), Rational(z[i] - level / d[i])));
    if (cap >= 0) x.back() = std::min(x.back(), cap);
  }
  return x;
}

RationalVector exact_ball(const RationalVector& z, const RationalVector& d, const Rational& radius) {
  Rational sum = 0;
  for (const Rational& v : z) sum += abs(v);
  if (sum <= radius) return z;
  RationalVector x = exact_capped(absolute(z), d, -1, radius);
  for (std::size_t i = 0; i < z.size(); ++i)
    if (z[i] < 0) x[i] = -x[i];
  return x;
}

}  // namespace

TEST_CASE("projections on the simplex are the sorted ones in fractions, ties and far points included") {
  for (const Sample& s : samples())
    for (double total : {0.0, 1e-6, 0.5, 1.0, 3.0, 1e4}) {
      CAPTURE(s.z.transpose());
      CAPTURE(total);
      const RationalVector z = oracles::rational(s.z), d = oracles::rational(s.d);
      const double bound = few * total;
      const Vector x = k::proj_simplex(s.z, total);
      CHECK(x.minCoeff() >= 0);
      CHECK(oracles::distance(x, exact_capped(z, ones(s.z.size()), -1, total)) <= bound);
      const Vector y = k::proj_simplex(s.z, total, s.d);
      CHECK(y.minCoeff() >= 0);
      CHECK(oracles::distance(y, exact_capped(z, d, -1, total)) <= bound);
    }
}

TEST_CASE("projections on the l1 ball are the sorted ones in fractions, and leave points inside alone") {
  for (const Sample& s : samples())
    for (double radius : {0.0, 0.5, 1.0, 6.0, 1e4}) {
      CAPTURE(s.z.transpose());
      CAPTURE(radius);
      const RationalVector z = oracles::rational(s.z), d = oracles::rational(s.d);
      const Vector x = k::proj_ball1(s.z, radius), y = k::proj_ball1(s.z, radius, s.d);
      CHECK(oracles::distance(x, exact_ball(z, ones(s.z.size()), radius)) <= few * radius);
      CHECK(oracles::distance(y, exact_ball(z, d, radius)) <= few * radius);
      if (s.z.lpNorm<1>() <= radius) CHECK((x == s.z && y == s.z));
    }
}

TEST_CASE("the proxes of max and of the norm of the largest entry cut at the level found in fractions") {
  for (const Sample& s : samples())
    for (double weight : {0.0, 0.5, 1.0, 7.0}) {
      CAPTURE(s.z.transpose());
      CAPTURE(weight);
      const double bound = few * (s.z.cwiseAbs().maxCoeff() + weight);
      for (bool metric : {false, true}) {
        CAPTURE(metric);
        const RationalVector z = oracles::rational(s.z);
        const RationalVector d = metric ? oracles::rational(s.d) : ones(s.z.size());
        const double smallest = metric ? s.d.minCoeff() : 1;
        const Rational level = oracles::level_of_height(z, d, -1, weight);
        RationalVector lowered = z, cut = z;
        for (Rational& v : lowered) v = std::min(v, level);
        const Vector x = metric ? k::prox_max(s.z, weight, s.d) : k::prox_max(s.z, weight);
        CHECK(oracles::distance(x, lowered) <= bound / std::min(1.0, smallest));
        const Rational size = std::max(Rational(0), oracles::level_of_height(absolute(z), d, -1, weight));
        for (Rational& v : cut) v = std::max(Rational(-size), std::min(v, size));
        const Vector y = metric ? k::prox_norm_inf(s.z, weight, s.d) : k::prox_norm_inf(s.z, weight);
        CHECK(oracles::distance(y, cut) <= bound / std::min(1.0, smallest));
      }
    }
}

TEST_CASE("the capped simplex and the sum of the largest entries agree with fractions") {
  for (const Sample& s : samples())
    for (double share : {0.0, 0.25, 0.5, 0.8, 1.0})
      for (double cap : {0.25, 1.0, 20.0}) {
        const Index n = s.z.size();
        const double total = share * static_cast<double>(n) * cap;
        CAPTURE(s.z.transpose());
        CAPTURE(total);
        CAPTURE(cap);
        const RationalVector z = oracles::rational(s.z), d = oracles::rational(s.d);
        CHECK(oracles::distance(k::proj_capped_simplex(s.z, cap, total),
                                exact_capped(z, ones(n), cap, total)) <= few * (cap + total));
        CHECK(oracles::distance(k::proj_capped_simplex(s.z, cap, total, s.d),
                                exact_capped(z, d, cap, total)) <= few * (cap + total));

        const double largest = std::floor(share * static_cast<double>(n));
        for (bool metric : {false, true}) {
          const RationalVector weights = metric ? d : ones(n);
          const Rational level = oracles::level_of_height(z, weights, cap, Rational(cap) * Rational(largest));
          RationalVector x;
          for (std::size_t i = 0; i < z.size(); ++i)
            x.push_back(std::max(std::min(z[i], level), Rational(z[i] - Rational(cap) / weights[i])));
          const Vector found =
              metric ? k::prox_sum_largest(s.z, largest, cap, s.d) : k::prox_sum_largest(s.z, largest, cap);
          if (largest > 0)
            CHECK(oracles::distance(found, x) <= few * (s.z.cwiseAbs().maxCoeff() + cap / s.d.minCoeff()));
        }
      }
}

TEST_CASE("projections keep the sum and the order whatever the number of entries and the scale") {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  for (Index n : {255, 256, 257, 1000, 30000})
    for (double scale : {1e-150, 1.0, 1e150})
      for (double spread : {1e-3, 1.0, 100.0}) {
        Vector z(n);
        for (double& v : z) v = scale * (1 + spread * normal(generator));
        const Vector x = k::proj_simplex(z, scale), y = k::proj_ball1(-z, scale);
        CHECK(std::abs(x.sum() / scale - 1) <= 1e-12);
        CHECK(std::abs(y.lpNorm<1>() / scale - 1) <= 1e-12);
        // z - x is one number where x > 0 and no larger elsewhere.
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        for (Index i = 0; i < n; ++i) {
          if (x[i] > 0) lowest = std::min(lowest, z[i] - x[i]);
          highest = std::max(highest, z[i] - x[i]);
        }
        CHECK(highest - lowest <= few * z.cwiseAbs().maxCoeff());
      }
}

TEST_CASE("entries that shrink geometrically do not make the filter quadratic, nor do equal ones") {
  Vector z(200000);
  for (Index i = 0; i < z.size(); ++i) z[i] = -std::ldexp(1, -static_cast<int>(i % 900));
  CHECK(std::abs(k::proj_simplex(z, 1).sum() - 1) <= 1e-12);
  CHECK(k::proj_simplex(Vector::Constant(4096, 3), 1) == Vector::Constant(4096, 0x1p-12));
}

TEST_CASE("an empty simplex, a negative radius and a metric that is none are refused") {
  const Vector z = Vector::Ones(3);
  CHECK_THROWS_AS(k::proj_simplex(z, -1), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_simplex(Vector(0), 1), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_ball1(z, -1), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_ball1(z, std::nan("")), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_simplex(z, 1, Vector::Zero(3)), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_simplex(z, 1, Vector::Ones(2)), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_capped_simplex(z, 1, 3.5), convex::InvalidInput);
  CHECK_THROWS_AS(k::prox_sum_largest(z, 4), convex::InvalidInput);
}

TEST_CASE("points so far away that the level rounds onto the topmost of them are projected as in fractions") {
  const auto near = [](const Vector& x, const Vector& right) {
    return (x - right).cwiseAbs().maxCoeff() <= 4 * convex::unit_roundoff * right.cwiseAbs().maxCoeff();
  };
  CHECK(near(k::proj_ball1(Vector{{1e17}}, 1, Vector{{2}}), Vector{{1}}));
  CHECK(near(k::proj_simplex(Vector{{2e16, 1e16}}, 1, Vector{{1, 2}}), Vector{{2.0 / 3, 1.0 / 3}}));
  CHECK(near(k::proj_simplex(Vector{{2e9, 1e9}}, 1e-8, Vector{{1, 2}}), Vector{{2e-8 / 3, 1e-8 / 3}}));
  for (const double far : {1e17, -1e17})
    CHECK(near(k::proj_capped_simplex(Vector{{far, far}}, 1, 1), Vector{{0.5, 0.5}}));
  CHECK(near(k::proj_capped_simplex(Vector{{1e17, -1e17, 3}}, 1, 3), Vector{{1, 1, 1}}));
  CHECK(near(k::proj_capped_simplex(Vector{{1e17, -1e17, 3}}, 1, 0), Vector{{0, 0, 0}}));
  // 1e6 times 0.1 is more than 1e5 by a rounding.
  CHECK(near(k::proj_capped_simplex(Vector::Ones(1000000), 0.1, 1e5), Vector::Constant(1000000, 0.1)));
}

TEST_CASE("kinks at which slopes are 2^60 apart do not hold the level fast") {
  const auto near = [](const Vector& x, const Vector& right) {
    return (x - right).cwiseAbs().maxCoeff() <= 4 * convex::unit_roundoff;
  };
  const double least = std::ldexp(1, -15);
  const Vector capped = k::proj_capped_simplex(Vector{{3, 0, 3, 0, 0, -3}}, 1, 5,
                                               Vector{{1, least, 1, least, 1 / least, least}});
  const double rest = 4 / (1 + std::ldexp(1, 30));  // (3 + 1) d_5 / (d_4 + d_5)
  CHECK(near(capped, Vector{{1, 1, 1, 1, rest, 1 - rest}}));
  const Vector d{{std::ldexp(1, 60), std::ldexp(1, -60)}};
  CHECK(near(k::prox_max(Vector{{0.5, 1.5}}, 1, d), Vector{{0.5, 0.5}}));
  const double far = std::ldexp(1, -30);
  const Vector largest = k::prox_sum_largest(Vector{{0, 1, 1.5}}, 2, 1, Vector{{1 / far, far, 1}});
  CHECK(near(largest, Vector{{-far, -far, 0.5}}));
}
