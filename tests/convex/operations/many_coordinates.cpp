#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "convex/functions/decomposition.hpp"
#include "convex/gamma0/call.hpp"
#include "tests/convex/operations/samples.hpp"

/// Functions of some hundred coordinates with parts of which none is separable, whose points one number
/// tells.
using convex::Index;
using convex::Metric;
using convex::Status;
using convex::Vector;

namespace {

Vector normal_vector(Index n, double size, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, size);
  return Vector::NullaryExpr(n, [&] { return normal(generator); });
}

/// The root of a function that falls from above 0 to below, to the last digit.
double falling_root(const std::function<double(double)>& f, double low, double high) {
  for (int halving = 0; halving < 200; ++halving) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0 ? low : high) = middle;
  }
  return low;
}

void check_point(const std::string& text, const Vector& z, const Vector& expected) {
  CAPTURE(text);
  const auto split = convex::decompose(samples::function(text, z.size()), z, Metric::identity(z.size()));
  REQUIRE(split.status == Status::solved);
  CHECK((split.x.x - expected).norm() <= 1e-12 * z.norm());
  CHECK((split.x.x - expected).norm() <= split.x.error_bound + 1e-14 * z.norm());
}

}  // namespace

TEST_CASE("in hundreds of coordinates a ball and a box have the nearest point that one multiplier tells") {
  const Vector z = normal_vector(300, 2, 1);
  const auto at = [&](double mu) { return Vector((z / (1 + mu)).cwiseMax(0.0).cwiseMin(2.0)); };
  for (const double radius : {1.0, 3.0}) {
    const double mu = falling_root([&](double m) { return at(m).norm() - radius; }, 0, 1e6);
    const std::string ball = "ball2(" + std::to_string(radius) + ")";
    check_point("intersection(" + ball + ", box(0, 2))", z, at(mu));
    check_point("sum(indicator(box(0, 2)), indicator(" + ball + "))", z, at(mu));
  }
}

TEST_CASE("in hundreds of coordinates a norm is shortened within a box") {
  const Vector z = normal_vector(300, 2, 2);
  const auto at = [&](double nu) { return Vector((z / (1 + nu)).cwiseMax(-1.0).cwiseMin(2.0)); };
  const double weight = 5, nu = falling_root([&](double m) { return weight - m * at(m).norm(); }, 0, 2);
  check_point("sum(norm2(5), indicator(box(-1, 2)))", z, at(nu));
}

TEST_CASE("in hundreds of coordinates an epigraph has the nearest point that its height tells") {
  const Index n = 300;
  Vector z = normal_vector(n + 1, 2, 3);
  z[n] = -40;
  // x_i = the prox of mu max(0, 1 - x) at z_i, and the height is z_n + mu.
  const auto at = [&](double mu) {
    Vector x(n + 1);
    for (Index i = 0; i < n; ++i) x[i] = z[i] >= 1 ? z[i] : std::min(1.0, z[i] + mu);
    x[n] = z[n] + mu;
    return x;
  };
  const auto above = [&](double mu) {
    const Vector x = at(mu);
    return (1 - x.head(n).array()).max(0.0).sum() - x[n];
  };
  check_point("indicator(epigraph(sum(hinge(), constant(0))))", z, at(falling_root(above, 0, 1e3)));
  check_point("sum(indicator(epigraph(hinge())), indicator(ball2(1000)))", z,
              at(falling_root(above, 0, 1e3)));
}

TEST_CASE(
    "in hundreds of coordinates a diamond, a ball and a half-space have the nearest point whose normals are "
    "told") {
  const Index n = 250;
  Vector a(n), x(n), v(n);
  for (Index i = 0; i < n; ++i) {
    a[i] = 0.5 * static_cast<double>((3 * i + i / 5) % 7) - 1;
    x[i] = i < 16 ? (i % 2 ? 0.5 : -0.5) : 0;
    const double of_diamond = x[i] != 0 ? std::copysign(1.0, x[i]) : 0.25 * static_cast<double>(i % 9 - 4);
    v[i] = 3 * of_diamond + 2 * a[i];
  }
  std::string row;
  for (Index i = 0; i < n; ++i) row += (i ? "," : "") + std::to_string(a[i]);
  // |x|₂ = 2: the ball takes no part.
  check_point("indicator(intersection(ball2(5), ball1(8), halfspace([" + row + "]," +
                  std::to_string(a.dot(x)) + ")))",
              x + v, x);
}

TEST_CASE("in hundreds of coordinates a largest entry and a length share a point as their slopes tell") {
  const Index n = 250;
  Vector centre(n), x(n), v(n);
  for (Index i = 0; i < n; ++i) {
    centre[i] = 0.5 * static_cast<double>(7 * i % 5) - 1;
    v[i] = static_cast<double>(i % 4);
    x[i] = centre[i] + (v[i] > 0 ? 5 : 5 - static_cast<double>(i % 3));
  }
  v /= v.sum();  // |v|₁ = 1, and |v|₂ < 1: the norm stays at its centre
  std::string by;
  for (Index i = 0; i < n; ++i) by += (i ? "," : "") + std::to_string(centre[i]);
  check_point("inf_convolution(norm_inf(), translate(norm2(), [" + by + "]))", x + v, x);
}

TEST_CASE(
    "in hundreds of coordinates a smooth maximum beside a norm and a ball is split where its slopes tell") {
  const Index n = 130;
  Vector centre(n), x(n), v(n);
  for (Index i = 0; i < n; ++i) {
    centre[i] = 0.125 * static_cast<double>(7 * i % 5) - 0.25;
    x[i] = i % 3 == 0 ? centre[i] : 0.125 * static_cast<double>(i * 11 % 13 - 6);
    const double of_norm = x[i] > centre[i] ? 1 : x[i] < centre[i] ? -1 : static_cast<double>(i % 5 - 2) / 3;
    v[i] = 0.125 * of_norm + 0.5 * x[i];
  }
  v += x.array().exp().matrix() / x.array().exp().sum();
  std::string by;
  for (Index i = 0; i < n; ++i) by += (i ? "," : "") + std::to_string(centre[i]);
  check_point("sum(log_sum_exp(), translate(norm1(0.125), [" + by + "]), indicator(ball2(" +
                  convex::to_text(x.norm()) + ")))",
              x + v, x);
}
