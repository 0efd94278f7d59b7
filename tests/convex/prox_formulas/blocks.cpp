#include "convex/prox_formulas/blocks.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/isotonic.hpp"
#include "convex/prox_formulas/total_variation.hpp"
#include "tests/convex/prox_formulas/rational_level.hpp"

using convex::Index;
using convex::Vector;
using convex::prox_formulas::Blocks;
using oracles::Rational;
using oracles::RationalVector;
namespace k = convex::prox_formulas;

namespace {

constexpr double few = 4 * convex::unit_roundoff;

struct Sample {
  Vector z, d;
};

std::vector<Sample> samples() {
  std::vector<Sample> found;
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  for (int kind = 0; kind < 5; ++kind)
    for (Index n : {1, 2, 3, 6, 13, 30})
      for (int repeat = 0; repeat < 4; ++repeat) {
        Sample s{Vector(n), Vector(n)};
        for (Index i = 0; i < n; ++i) {
          const double tie = static_cast<double>(generator() % 7) - 3, place = static_cast<double>(i);
          s.z[i] = kind == 0   ? tie
                   : kind == 1 ? 10 * normal(generator)
                   : kind == 2 ? 1e12 + tie
                   : kind == 3 ? 3 * place + tie
                               : -place + tie / 2;
          s.d[i] = repeat % 2 == 0 ? static_cast<double>(1 + generator() % 4) : std::exp(normal(generator));
        }
        found.push_back(s);
      }
  return found;
}

/// max over j <= i of min over l >= i of the mean of z_j..z_l.
RationalVector max_min(const RationalVector& z, const RationalVector& d) {
  RationalVector x;
  for (std::size_t i = 0; i < z.size(); ++i) {
    Rational best;
    for (std::size_t j = 0; j <= i; ++j) {
      Rational sum = 0, weight = 0, least;
      for (std::size_t l = j; l < z.size(); ++l) {
        sum += d[l] * z[l];
        weight += d[l];
        if (l == i || (l > i && sum / weight < least)) least = sum / weight;
      }
      if (j == 0 || least > best) best = least;
    }
    x.push_back(best);
  }
  return x;
}

RationalVector negative(RationalVector z) {
  for (Rational& v : z) v = -v;
  return z;
}

/// The runs of a total variation answer, their values in fractions, the jumps between them having the signs
/// found. Returns whether every condition of optimality holds exactly: Σ_(j<=i) d_j (x_j - z_j) is weight
/// times the sign of the jump after i, at most weight in size where there is none, 0 at the end.
bool is_taut(const Blocks& blocks, const RationalVector& z, const RationalVector& d, const Rational& weight,
             RationalVector& x) {
  const std::size_t n = z.size();
  x.assign(n, 0);
  std::vector<int> jump(n, 0);  // after entry i
  std::vector<std::size_t> first(blocks.first.begin(), blocks.first.end());
  first.push_back(n);
  for (std::size_t b = 0; b + 2 < first.size(); ++b) {
    const auto last = static_cast<Index>(first[b + 1]) - 1;
    jump[first[b + 1] - 1] = blocks.x[last + 1] > blocks.x[last]   ? 1
                             : blocks.x[last + 1] < blocks.x[last] ? -1
                                                                   : 0;
    if (jump[first[b + 1] - 1] == 0) return false;
  }
  for (std::size_t b = 0; b + 1 < first.size(); ++b) {
    Rational sum = 0, weights = 0;
    for (std::size_t i = first[b]; i < first[b + 1]; ++i) {
      sum += d[i] * z[i];
      weights += d[i];
    }
    const int before = b > 0 ? jump[first[b] - 1] : 0, after = jump[first[b + 1] - 1];
    for (std::size_t i = first[b]; i < first[b + 1]; ++i) x[i] = (sum + weight * (after - before)) / weights;
  }
  Rational sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += d[i] * (x[i] - z[i]);
    if (abs(sum) > weight) return false;
    if (i + 1 < n && x[i + 1] != x[i] && sum != (x[i + 1] > x[i] ? weight : Rational(-weight))) return false;
  }
  return sum == 0;
}

}  // namespace

TEST_CASE("isotonic regression is the max-min of means in fractions, in every weight and both directions") {
  for (const Sample& s : samples()) {
    CAPTURE(s.z.transpose());
    const RationalVector z = oracles::rational(s.z), d = oracles::rational(s.d), one(z.size(), Rational(1));
    const double bound = few * s.z.cwiseAbs().maxCoeff();
    CHECK(oracles::distance(k::proj_monotone(s.z).x, max_min(z, one)) <= bound);
    CHECK(oracles::distance(k::proj_monotone(s.z, s.d).x, max_min(z, d)) <= bound);
    CHECK(oracles::distance(k::proj_decreasing(s.z).x, negative(max_min(negative(z), one))) <= bound);
    CHECK(oracles::distance(k::proj_decreasing(s.z, s.d).x, negative(max_min(negative(z), d))) <= bound);
  }
}

TEST_CASE("means of integers are exact, and points in the monotone cone stay") {
  const Vector z = (Vector(6) << 3, 1, 2, 2, 7, 5).finished();
  CHECK(k::proj_monotone(z).x == (Vector(6) << 2, 2, 2, 2, 6, 6).finished());
  const Vector inside = (Vector(4) << -1e150, -0.0, 1e-300, 1e150).finished();
  CHECK(k::proj_monotone(inside).x == inside);
  CHECK(k::proj_monotone(inside, Vector::Constant(4, 3)).x == inside);
}

TEST_CASE("the taut string meets the conditions of optimality exactly, in fractions") {
  for (const Sample& s : samples())
    for (double weight : {0.25, 1.0, 3.0, 50.0})
      for (bool metric : {false, true}) {
        CAPTURE(s.z.transpose());
        CAPTURE(s.d.transpose());
        CAPTURE(weight);
        const Blocks found =
            metric ? k::prox_total_variation(s.z, weight, s.d) : k::prox_total_variation(s.z, weight);
        const RationalVector z = oracles::rational(s.z),
                             d = metric ? oracles::rational(s.d) : RationalVector(z.size(), Rational(1));
        RationalVector x;
        CHECK(is_taut(found, z, d, weight, x));
        CHECK(oracles::distance(found.x, x) <= few * s.z.cwiseAbs().maxCoeff());
      }
}

TEST_CASE(
    "total variation without weight or of one entry changes nothing, with a large weight it is the mean") {
  const Vector z = (Vector(5) << 4, -1, 0, 2, 5).finished();
  CHECK(k::prox_total_variation(z, 0).x == z);
  CHECK(k::prox_total_variation(z.head(1), 3).x == z.head(1));
  CHECK(k::prox_total_variation(z, 1e3).x == Vector::Constant(5, 2));
  CHECK(k::prox_total_variation(z * 0x1p500, 0x1p510).x == Vector::Constant(5, 0x1p501));
  CHECK(k::prox_total_variation(z * 0x1p-500, 0x1p-490).x == Vector::Constant(5, 0x1p-499));
}

TEST_CASE("data on which a string is redrawn again and again take no more than linear time") {
  const Index n = 200000;  // each entry moves the end of a long straight string: quadratic for Condat 2013
  Vector z(n);
  for (Index i = 0; i < n; ++i) z[i] = static_cast<double>(i) * 1e-9;
  z[n - 1] = -1e9;
  const Vector x = k::prox_total_variation(z, 1e3).x;
  CHECK(std::abs(x.sum() - z.sum()) <= 1e-9 * 1e9);
}

TEST_CASE("the sorted l1 prox is that of norm1 for equal weights and keeps Moreau's identity in general") {
  std::mt19937 generator(5);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const Index n = 1 + static_cast<Index>(generator() % 12);
    Vector z(n), w(n);
    for (double& v : z) v = static_cast<double>(generator() % 21) - 10;
    double size = 0;
    for (Index i = n; i-- > 0;) w[i] = size += static_cast<double>(generator() % 3);
    const Vector x = k::prox_sorted_norm1(z, w), y = z - x;
    // y is in the dual ball (partial sums of sorted |y| below those of w) and attains the norm at x.
    Vector sorted_x = x.cwiseAbs(), sorted_y = y.cwiseAbs();
    std::sort(sorted_x.begin(), sorted_x.end(), std::greater<>());
    std::sort(sorted_y.begin(), sorted_y.end(), std::greater<>());
    double excess = -1e300, sum = 0;
    for (Index i = 0; i < n; ++i) excess = std::max(excess, sum += sorted_y[i] - w[i]);
    CHECK(excess <= 1e-13);
    CHECK(std::abs(sorted_x.dot(w) - x.dot(y)) <= 1e-12);
  }
}

TEST_CASE("weights that do not fit, are not positive or not sorted are refused") {
  const Vector z = Vector::Ones(3);
  CHECK_THROWS_AS(k::proj_monotone(z, Vector::Ones(2)), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_monotone(z, Vector::Zero(3)), convex::InvalidInput);
  CHECK_THROWS_AS(k::prox_total_variation(z, -1), convex::InvalidInput);
  CHECK_THROWS_AS(k::prox_total_variation(z, 1, -z), convex::InvalidInput);
  CHECK_THROWS_AS(k::prox_sorted_norm1(z, Vector::LinSpaced(3, 1, 2)), convex::InvalidInput);
}
