#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "convex/functions/decomposition.hpp"
#include "convex/invalid_input.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Matrix;
using convex::Metric;
using convex::Vector;

namespace {

/// f □ g and a direction d along which f(w) + g(z - w) comes to its infimum, w = z + t d.
struct Approached {
  const char* first;
  const char* second;
  Vector direction;
  double infimum;
};

const Approached not_attained[] = {
    {"inverse_power(1)", "total_variation(2)", Eigen::Vector3d(1, 1, 1), 0},
    {"inverse_power(0.5)", "indicator(polyhedron([[-3,1,0],[0,1,0],[0,0,1]],[1,6,2]))",
     Eigen::Vector3d(1, 4, 1), 0},
    {"inverse_power(1)", "squared_distance(halfspace([-3,2,-2],-2),2)", Eigen::Vector3d(1, 4, 1), 0}};

}  // namespace

TEST_CASE(
    "an infimum that is approached along a ray alone is its limit, with a prox that stays at its point") {
  Matrix gram(3, 3);
  gram << 4, 1, 0, 1, 3, -1, 0, -1, 2;
  const Vector z = Eigen::Vector3d(-2, 1, 0.5);
  for (const Approached& pair : not_attained) {
    CAPTURE(pair.first);
    CAPTURE(pair.second);
    const auto f = samples::function(pair.first, 3), g = samples::function(pair.second, 3);
    const auto least =
        samples::function("inf_convolution(" + std::string(pair.first) + "," + pair.second + ")", 3);
    CHECK(least(z) == pair.infimum);
    double before = std::numeric_limits<double>::infinity();
    for (const double t : {1e3, 1e6, 1e9}) {
      const double above = f(z + t * pair.direction) + g(-t * pair.direction);
      CHECK(above >= pair.infimum);
      CHECK(above < before);
      before = above;
    }
    const auto split = convex::decompose(least, z, Metric::dense(gram));
    CHECK(split.status == convex::Status::solved);
    CHECK((split.x.x - z).norm() <= 1e-15 * z.norm());
    CHECK(split.y.x.norm() <= 1e-15 * z.norm());
  }
}

TEST_CASE("slopes in common that are more than one leave an infimum where it is attained") {
  const auto least = samples::function("inf_convolution(inverse_power(1), norm1())", 2);
  // 1/w + |x - w|: at x = 4 no w is better than x, at x = 1/4 none better than 1.
  CHECK(least(Eigen::Vector2d(4, 0.25)) == doctest::Approx(0.25 + 1.75).epsilon(1e-12));
}

TEST_CASE("entries that are pinned beside others that are free are lines, and the others as they were") {
  // Of the slopes (v, w) the plane has w alone, v = 0: the first entry is free to go out.
  const auto least = samples::function("inf_convolution(inverse_power(1), distance(affine([[0,1]],0),3))", 2);
  const auto alone = samples::function("inf_convolution(inverse_power(1), norm1(3))", 1);
  for (const double x : {0.1, 0.5, 2.0, 40.0}) {
    CAPTURE(x);
    CHECK(least(Eigen::Vector2d(-7, x)) == doctest::Approx(alone(Vector::Constant(1, x))).epsilon(1e-12));
  }
}

TEST_CASE("one slope in common of a shifted envelope and a ridge makes their infimum a line") {
  // v = (-3,-1,-3,3) + s (1,-1,-1,3) with no entry above 0: s = -1 alone.
  const Vector v = Eigen::Vector4d(-4, 0, -2, 0), shift = Eigen::Vector4d(-1, 0, -3, 0);
  const auto least = samples::function(
      "inf_convolution(tilt(squared_distance(affine([[1,-1,-1,3]],0),12),[-3,-1,-3,3]),"
      "envelope(translate(inverse_power(1),[-1,0,-3,0]),3))",
      4);
  // ½ s² |a|²/12 of the ridge, v·shift + 3/2 |v|² - 2 sum sqrt(-v_i) of the envelope
  const double conjugates = 0.5 + v.dot(shift) + 30 - 2 * (2 + std::sqrt(2.0));
  for (const Vector& x :
       {Vector(Vector::Zero(4)), Vector(Eigen::Vector4d(3, 0, 3, 3)), Vector(1e8 * shift)}) {
    const convex::Value found = least.evaluate(x);
    const double truth = v.dot(x) - conjugates;
    CHECK(std::abs(found.value - truth) <= 1e-14 * (std::abs(truth) + 100));
    CHECK(found.error <= 1e-12 * (std::abs(truth) + 100));
  }
}

TEST_CASE("where a shift puts a point on the open end of a domain, no finite value is told as known") {
  const auto g = samples::function("tilt(negative_power(0.5),[1])", 1).conjugate();  // 1/(4(1 - v))
  const convex::Value end = g.evaluate(Vector::Ones(1));
  CHECK((std::isinf(end.value) || end.error >= std::abs(end.value)));
  const convex::Value inside = g.evaluate(Vector::Constant(1, 0.5));
  CHECK(inside.value == doctest::Approx(0.5).epsilon(1e-14));
  CHECK(inside.error <= 1e-14);
}

TEST_CASE(
    "a point whose square leaves the range of doubles has no bound, and below it the bound covers what is "
    "lost") {
  const auto f = samples::function("sum(norm2(1e-200), indicator(orthant()))", 2);
  const Vector z = 1e-200 * Eigen::Vector2d(1, 2);
  const auto split = convex::decompose(f, z, Metric::identity(2));
  const Vector x = (1 - 1 / std::sqrt(5.0)) * z;
  CHECK((split.x.x - x).stableNorm() <= split.error_bound);
  CHECK((split.y.x - (z - x)).stableNorm() <= split.error_bound);
  const auto far = convex::decompose(f, 1e200 * Eigen::Vector2d(1, 2), Metric::identity(2));
  CHECK(far.status == convex::Status::inaccurate);
  CHECK(std::isinf(far.error_bound));
}

TEST_CASE("the value of a program far out is known to its own size, not to that of the point") {
  // min over w of 1/2 (x - w)²- - sqrt(w), which is -sqrt(x) - 1/(8x) + O(x^-5/2)
  const auto f = samples::function("inf_convolution(squared_distance(orthant(),1),negative_power(0.5))", 1);
  for (const double x : {1e6, 1e8, 1e9, 1e10, 1e11, 1e12, 1e15}) {
    CAPTURE(x);
    const convex::Value found = f.evaluate(Vector::Constant(1, x));
    const double truth = -std::sqrt(x) - 1 / (8 * x);
    CHECK(std::abs(found.value - truth) <= found.error + 1e-15 * std::sqrt(x));
    CHECK(found.error <= 1e-12 * std::sqrt(x));
  }
}

TEST_CASE("the value of a program is not that of scales at which its misses look small") {
  // The support function of [0, 1/4], whose program has more rows than it needs.
  const auto g = samples::function(
                     "sum(total_variation(1),indicator(intersection(intersection(box(-1,2),ball2(0.25)),"
                     "intersection(box(-1,2),box(0,inf)))))",
                     1)
                     .conjugate();
  const convex::Value far = g.evaluate(Vector::Constant(1, 3125000));
  CHECK(std::abs(far.value - 781250) <= far.error + 1e-9 * 781250);
  // The maximum of two convex functions that cross, where the slopes are of size 1 and v is not.
  const auto h = samples::function("pointwise_max(kullback_leibler(2), squared_norm2(3))", 1).conjugate();
  const convex::Value small = h.evaluate(Vector::Constant(1, -1e-12));
  CHECK(std::abs(small.value - h(Vector::Zero(1))) <= small.error + 1e-11);
}
