#include "mechanics/motion/polynomial_root.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using mechanics::first_zero;
using mechanics::least_value;

namespace {

/// Π (1 - x / root): positive at 0.
std::vector<double> with_roots(const std::vector<double>& roots) {
  std::vector<double> c{1};
  for (const double root : roots) {
    c.push_back(0);
    for (std::size_t k = c.size() - 1; k > 0; --k) c[k] -= c[k - 1] / root;
  }
  return c;
}

}  // namespace

TEST_CASE("the first of many roots is found, wherever the others are") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> roots;
    for (int k = 0; k < 8; ++k)
      if (const double root = anywhere(random); std::abs(root) > 0.2) roots.push_back(root);
    double first = 1, second = 1;
    for (const double root : roots) {
      if (root > 0 && root < first)
        second = first, first = root;
      else if (root > 0)
        second = std::min(second, root);
    }
    const std::vector<double> c = with_roots(roots);
    double size = 0;
    for (const double x : c) size += std::abs(x);
    const auto found = first_zero(c, 1, 1e-15 * size);
    if (first >= 1) {
      CHECK_FALSE(found);
    } else if (second - first > 1e-3) {
      REQUIRE(found);
      CHECK(std::abs(found->at - first) <= 1e-8);
      CHECK_FALSE(found->is_touch);
    }
  }
}

TEST_CASE("two roots as close as 1e-6 are a crossing, a double root is a touch, a near miss is nothing") {
  for (const double apart : {1e-2, 1e-4, 1e-6}) {
    const auto found = first_zero(with_roots({0.5, 0.5 + apart, 3}), 1, 1e-15);
    REQUIRE(found);
    CHECK_FALSE(found->is_touch);
    CHECK(std::abs(found->at - 0.5) <= 1e-9);
  }
  const auto twice = first_zero(with_roots({0.5, 0.5, 3}), 1, 1e-15);
  REQUIRE(twice);
  CHECK(twice->is_touch);
  CHECK(std::abs(twice->at - 0.5) <= 1e-7);
  std::vector<double> above = with_roots({0.5, 0.5, 3});
  above[0] += 1e-12;
  CHECK_FALSE(first_zero(above, 1, 1e-15));
}

TEST_CASE("a touch before a crossing comes first, a rise from within rounding is no event") {
  const auto touch = first_zero(with_roots({0.25, 0.25, 0.75}), 1, 1e-15);
  REQUIRE(touch);
  CHECK(touch->is_touch);
  CHECK(touch->at == doctest::Approx(0.25).epsilon(1e-6));
  const double rising[] = {1e-18, 1, 0.5};
  CHECK_FALSE(first_zero(rising, 1, 1e-15));
  const double rising_and_falling[] = {0, 1, -2};  // x (1 - 2x)
  const auto later = first_zero(rising_and_falling, 1, 1e-15);
  REQUIRE(later);
  CHECK(later->at == doctest::Approx(0.5).epsilon(1e-15));
}

TEST_CASE("a root at the end of the interval belongs to it, one behind it does not") {
  const double falling[] = {1, -1};
  CHECK(first_zero(falling, 1, 1e-16));
  CHECK_FALSE(first_zero(falling, 0.999, 1e-16));
}

TEST_CASE("what rises from a 0 that rounding has put below itself is met where it comes back") {
  // -s + v x - x²/2 + x³ comes back to -s at x = 2 v, nearly, and is above 0 again from x = 1/2 on.
  const double v = 1e-8;
  for (const double s : {0.0, 1e-16, 2.5e-16, 1e-15}) {
    const auto found = first_zero(std::vector<double>{-s, v, -0.5, 1}, 0.8, 2e-16);
    REQUIRE(found);
    CHECK(std::abs(found->at - 2 * v) <= 1e-6 * v);
    CHECK_FALSE(found->is_touch);
  }
}

TEST_CASE("the least value of a polynomial is found inside an interval, however narrow its dip") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(0.05, 0.95);
  for (int trial = 0; trial < 500; ++trial) {
    // (x - a)² (x + 2) (x² + 1) - d: least near a, at -d exactly.
    const double a = anywhere(random), d = std::pow(10.0, -3 - 9 * anywhere(random));
    std::vector<double> c = with_roots({a, a, -2});
    for (double& x : c) x *= 2 * a * a;
    c.push_back(0), c.push_back(0);
    for (std::size_t k = c.size() - 1; k > 1; --k) c[k] += c[k - 2];
    c[0] -= d;
    CHECK(std::abs(least_value(c, 1, 0) + d) <= 1e-13);
    CHECK(least_value(c, 0.5 * a, 0) == 0);
    CHECK(least_value(c, 1, -2 * d - 1e-12) == -2 * d - 1e-12);
  }
}
