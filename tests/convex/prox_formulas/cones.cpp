#include <doctest/doctest.h>

#include <array>
#include <functional>
#include <random>
#include <string>

#include "convex/invalid_input.hpp"
#include "convex/prox_formulas/exponential_cone.hpp"
#include "convex/prox_formulas/power_cone.hpp"
#include "convex/prox_formulas/second_order_cone.hpp"

using convex::Index;
using convex::Vector;
using Eigen::Vector3d;
namespace k = convex::prox_formulas;

namespace {

using Long = long double;
using LongVector = Eigen::Matrix<Long, Eigen::Dynamic, 1>;

using Holds = std::function<bool(const LongVector&)>;

/// A cone by its definition, with a point inside that is at a distance of at least 1 from the boundary; the
/// same of the polar.
struct Cone {
  std::string name;
  Index n;
  std::function<Vector(const Vector&)> proj, proj_polar;
  Holds contains, polar_contains;
  Vector inner, polar_inner;
};

Vector of3(const Vector3d& x) { return x; }

bool in_exponential(const LongVector& p) {
  if (p[1] > 0) return p[1] * std::exp(p[0] / p[1]) <= p[2];
  return p[1] >= 0 && p[0] <= 0 && p[2] >= 0;
}

bool in_exponential_polar(const LongVector& p) {
  if (p[0] > 0) return p[0] * std::exp(p[1] / p[0] - 1) <= -p[2];
  return p[0] >= 0 && p[1] <= 0 && p[2] <= 0;
}

bool in_power(Long x, Long y, Long z, Long alpha) {
  return x >= 0 && y >= 0 && std::pow(x, alpha) * std::pow(y, 1 - alpha) >= std::abs(z);
}

Cone power_cone(double alpha) {
  const Long a = alpha;
  return {"power cone " + std::to_string(alpha),
          3,
          [alpha](const Vector& z) { return of3(k::proj_power_cone(z, alpha)); },
          [alpha](const Vector& z) { return of3(k::proj_power_polar(z, alpha)); },
          [a](const LongVector& p) { return in_power(p[0], p[1], p[2], a); },
          [a](const LongVector& p) { return in_power(-p[0] / a, -p[1] / (1 - a), p[2], a); },
          Vector3d(2, 2, 0),
          Vector3d(-2, -2, 0)};
}

Cone second_order_cone(Index n) {
  const auto in = [n](const LongVector& p, Long side) {
    return p.head(n - 1).stableNorm() <= side * p[n - 1];
  };
  return {"second-order cone",
          n,
          k::proj_second_order_cone,
          k::proj_second_order_polar,
          [=](const LongVector& p) { return in(p, 1); },
          [=](const LongVector& p) { return in(p, -1); },
          2 * Vector::Unit(n, n - 1),
          -2 * Vector::Unit(n, n - 1)};
}

Cone rotated_cone(Index n) {
  const auto in = [n](const LongVector& p, Long side) {
    const Long a = side * p[n - 2], b = side * p[n - 1];
    return a >= 0 && b >= 0 && p.head(n - 2).stableNorm() <= std::sqrt(2.0L) * std::sqrt(a) * std::sqrt(b);
  };
  const Vector both = 2 * (Vector::Unit(n, n - 1) + Vector::Unit(n, n - 2));
  return {"rotated second-order cone",
          n,
          k::proj_rotated_cone,
          k::proj_rotated_polar,
          [=](const LongVector& p) { return in(p, 1); },
          [=](const LongVector& p) { return in(p, -1); },
          both,
          -both};
}

std::vector<Cone> cones() {
  std::vector<Cone> found{{"exponential cone", 3,
                           [](const Vector& z) { return of3(k::proj_exponential_cone(z)); },
                           [](const Vector& z) { return of3(k::proj_exponential_polar(z)); }, in_exponential,
                           in_exponential_polar, Vector3d(-2, 2, 3.5), Vector3d(2, -2, -3.5)}};
  for (double alpha : {0.5, 0.25, 0.7, 0.01, 0.99, 1.0 / 3}) found.push_back(power_cone(alpha));
  for (Index n : {1, 2, 3, 7}) found.push_back(second_order_cone(n));
  for (Index n : {2, 3, 6}) found.push_back(rotated_cone(n));
  return found;
}

/// Roundings that a condition of optimality may be off, relative to |z|.
constexpr Long roundings = 16 * 0x1p-53L;

struct Counts {
  int inside = 0, polar = 0, between = 0;
};

/// x in K, y in the polar of K, x·y = 0 and x + y = z, which determine both (Moreau 1962).
void check_split(const Cone& cone, const Vector& z, Counts& counts) {
  CAPTURE(cone.name);
  CAPTURE(z.transpose());
  const Vector x = cone.proj(z), y = cone.proj_polar(z);
  CAPTURE(x.transpose());
  CAPTURE(y.transpose());
  REQUIRE(x.allFinite());
  REQUIRE(y.allFinite());
  const LongVector lx = x.cast<Long>(), ly = y.cast<Long>(), lz = z.cast<Long>();
  const Long size = lz.stableNorm(), slack = roundings * size;
  // A point at a distance of at most `slack` from the cone comes into it along the inner point.
  const LongVector in = slack * cone.inner.cast<Long>(), in_polar = slack * cone.polar_inner.cast<Long>();
  CHECK(cone.contains(lx + in));
  CHECK(cone.polar_contains(ly + in_polar));
  CHECK(cone.polar_contains(lz - lx + in_polar));
  CHECK((lx + ly - lz).stableNorm() <= slack);
  CHECK(std::abs(lx.dot(ly)) <= slack * size);
  if (cone.contains(lz - in)) {
    CHECK(x == z);
    CHECK(y == Vector::Zero(cone.n));
    ++counts.inside;
  } else if (cone.polar_contains(lz - in_polar)) {
    CHECK(x == Vector::Zero(cone.n));
    CHECK(y == z);
    ++counts.polar;
  } else {
    ++counts.between;
  }
}

}  // namespace

TEST_CASE("a point is the sum of two orthogonal ones, in the cone and in its polar, by two formulas") {
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  for (const Cone& cone : cones()) {
    Counts counts;
    for (int repeat = 0; repeat < 1500; ++repeat) {
      Vector z(cone.n);
      const double spread = repeat % 4 == 0 ? 0 : repeat % 4 == 1 ? 2 : repeat % 4 == 2 ? 8 : 30;
      for (double& v : z) v = normal(generator) * std::exp(spread * normal(generator));
      check_split(cone, z, counts);
    }
    CAPTURE(cone.name);
    CHECK(counts.inside > 30);
    CHECK(counts.polar > 10);
    if (cone.n > 1) CHECK(counts.between > 200);
  }
}

TEST_CASE("points on axes, edges, faces, at the apex and on small integers split as well") {
  for (const Cone& cone : cones()) {
    Counts counts;
    const Index n = std::min<Index>(cone.n, 3);
    for (int code = 0; code < 343; ++code) {
      Vector z = Vector::Zero(cone.n);
      for (Index i = 0, rest = code; i < n; ++i, rest /= 7)
        z[cone.n - 1 - i] =
            std::array{0.0, -0.0, 1.0, -1.0, 2.0, -2.0, 0.5}[static_cast<std::size_t>(rest % 7)];
      check_split(cone, z, counts);
    }
  }
}

TEST_CASE("scale changes nothing: points 1e150 times larger and smaller split to the same roundings") {
  std::mt19937 generator(4);
  std::normal_distribution<double> normal;
  for (const Cone& cone : cones()) {
    Counts counts;
    for (int repeat = 0; repeat < 100; ++repeat)
      for (int exponent : {-500, 500}) {
        Vector z(cone.n);
        for (double& v : z) v = std::ldexp(normal(generator), exponent);
        check_split(cone, z, counts);
        Vector mixed(cone.n);
        for (double& v : mixed) v = std::ldexp(normal(generator), static_cast<int>(generator() % 1000) - 500);
        check_split(cone, mixed, counts);
      }
  }
}

TEST_CASE(
    "points a rounding, or a little, away from the boundary of the cone and of the polar split as well") {
  std::mt19937 generator(6);
  std::normal_distribution<double> normal;
  for (const Cone& cone : cones()) {
    Counts counts;
    for (int repeat = 0; repeat < 200; ++repeat) {
      Vector z(cone.n), move(cone.n);
      for (double& v : z) v = normal(generator) * std::exp(3 * normal(generator));
      for (double& v : move) v = normal(generator);
      for (const Vector& boundary : {cone.proj(z), cone.proj_polar(z)})
        for (double distance : {0.0, 1e-16, 1e-14, 1e-10, 1e-6, 1e-3})
          check_split(cone, boundary + distance * z.norm() * move, counts);
    }
  }
}

TEST_CASE("long steep rays: nearly in the polar of the exponential cone the answer keeps its digits") {
  const Cone cone = cones()[0];
  Counts counts;
  for (double steep : {1.0, 5.0, 30.0, 100.0, 600.0, 738.0, 745.0, 1e5, 1e200})
    for (double side : {1.0, -1.0})
      for (double t : {-1.0, -1e-30, 0.0, 1e-30, 1e-9, 0.3, 1.0, 1e9}) {
        check_split(cone, Eigen::Vector3d(1, -side * steep, t), counts);
        check_split(cone, Eigen::Vector3d(-side * steep, 1, t), counts);
        check_split(cone, Eigen::Vector3d(1e-3, -side * steep, t), counts);
        check_split(cone, Eigen::Vector3d(steep, side / steep, t), counts);
      }
}

TEST_CASE("cited values: distances of the exponential cone by hand, and a tie of the rotated cone") {
  // Nearest to (1, 0, 0)... the ray with A = (rho - 1)/det, B = 1/det: (rho - 1) e^rho = e^-rho.
  const Vector3d x = k::proj_exponential_cone({1, 0, 0});
  const Long rho = static_cast<Long>(x[0]) / static_cast<Long>(x[1]);
  CHECK(std::abs((rho - 1) * std::exp(2 * rho) - 1) <= 1e-14L);
  CHECK(k::proj_exponential_cone({-2, -1, 3}) == Vector3d(-2, 0, 3));
  CHECK(k::proj_exponential_cone({-2, -1, -3}) == Vector3d(-2, 0, 0));
  CHECK((k::proj_second_order_cone(Eigen::Vector3d(3, 4, 0)) - Vector(Eigen::Vector3d(1.5, 2, 2.5))).norm() <=
        1e-15);
  CHECK((k::proj_rotated_cone(Eigen::Vector3d(0, 1, -1)) - Vector(Eigen::Vector3d(0, 1, 0))).norm() <= 1e-15);
}

TEST_CASE("a power outside (0, 1) and a point with too few entries are refused") {
  for (double alpha : {0.0, 1.0, -1.0, 2.0, std::nan("")})
    CHECK_THROWS_AS(k::proj_power_cone({1, 1, 1}, alpha), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_second_order_cone(Vector(0)), convex::InvalidInput);
  CHECK_THROWS_AS(k::proj_rotated_cone(Vector::Ones(1)), convex::InvalidInput);
}
