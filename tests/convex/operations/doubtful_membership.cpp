#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "tests/convex/operations/samples.hpp"

/// Between what a prox may miss a set by, 1e-12 of its size, and the membership tolerance, 1e-9, a point
/// counts as inside and the doubt is told.
using convex::Function;
using convex::Metric;
using convex::Value;
using convex::Vector;

namespace {

struct WayOut {
  const char* f;
  std::vector<double> at, towards;  ///< a point of the boundary and the way out of the domain there
};

const WayOut ways_out[] = {
    {"indicator(box(-1, 1))", {1, 0}, {1, 0}},
    {"indicator(ball2(2))", {0, 2}, {0, 1}},
    {"indicator(halfspace([3, 4], 5))", {1, 0.5}, {3, 4}},
    {"indicator(hyperplane([3, 4], 5))", {1, 0.5}, {-3, -4}},
    {"indicator(orthant())", {0, 1}, {-1, 0}},
    {"indicator(second_order_cone())", {1, 1}, {1, 0}},
    {"indicator(polyhedron([[1, 1], [1, -1]], [2, 2]))", {2, 0}, {1, 0}},
    {"indicator(simplex(2))", {1, 1}, {1, 1}},
    {"support(halfspace([3, 4], 5))", {3, 4}, {4, -3}},
    {"conjugate(linear([2, -1]))", {2, -1}, {1, 0}},
    {"conjugate(quadratic([[1, 0], [0, 0]], [2, 1]))", {5, 1}, {0, 1}},
    {"conjugate(total_variation(2))", {2, -2}, {1, 1}},
    {"indicator(epigraph(squared_norm2(2)))", {2, 4}, {0, -1}},
    {"negative_power(0.5)", {0, 1}, {-1, 0}},
    {"plq([0], [[inf, 0, 0], [1, 0, 0]])", {0, 1}, {-1, 0}},
    {"translate(indicator(orthant()), [3, -1])", {3, 1}, {-1, 0}},
    {"precompose(indicator(orthant()), [[1, 2], [3, -1]], [0, 0])", {2, -1}, {-1, -2}},
};

}  // namespace

TEST_CASE("a point that a set takes in by its tolerance alone is told with the doubt, one of a prox is not") {
  for (const WayOut& edge : ways_out) {
    CAPTURE(std::string(edge.f));
    const Function f = samples::function(edge.f, 2);
    const Vector at = Eigen::Map<const Vector>(edge.at.data(), 2);
    const Vector out = Eigen::Map<const Vector>(edge.towards.data(), 2).normalized() * at.norm();
    CHECK(f.evaluate(at).error <= 1e-12 * (1 + std::abs(f(at))));
    const Value beside = f.evaluate(at + 1e-14 * out), doubtful = f.evaluate(at + 3e-11 * out);
    CHECK(std::isfinite(beside.value));
    CHECK(std::isfinite(beside.error));
    CHECK((std::isinf(doubtful.error) || std::isinf(doubtful.value)));
    const Value outside = f.evaluate(at + 1e-6 * out);
    CHECK(outside.value == std::numeric_limits<double>::infinity());
    CHECK(outside.error == 0);
  }
}

TEST_CASE("a slope that is small beside slopes that cancel is not told to be in the domain of a conjugate") {
  for (const char* f :
       {"scale(tilt(linear([-2]), [2]), 1024)", "dilate(tilt(sum_largest(1), [-1]), 0.0009765625)"}) {
    CAPTURE(std::string(f));  // the zero function
    const Function g = samples::function(f, 1).conjugate();
    const Value inside = g.evaluate(Vector::Zero(1)), beside = g.evaluate(Vector::Constant(1, 1e-6));
    CHECK(inside.value == 0);
    CHECK(inside.error == 0);
    CHECK((std::isinf(beside.value) || std::isinf(beside.error)));
  }
}

TEST_CASE("the distance of a point is told, however near 0 it is, to a set that ends at 0") {
  for (const char* set : {"ball2(1, [1])", "box(0, 1)", "intersection(ball2(1, [1]), box(-inf, 0.5))"})
    for (const double x : {-1e-8, -1e-10, -1e-13}) {
      CAPTURE(std::string(set));
      CAPTURE(x);
      const Value found =
          samples::function("distance(" + std::string(set) + ", 2)", 1).evaluate(Vector::Constant(1, x));
      CHECK(std::abs(found.value - 2 * std::abs(x)) <= found.error);
      CHECK(found.error <= 1e-11);
    }
}

TEST_CASE("the distance to a set without an end is 0 at its points, alone and in an inf-convolution") {
  const char* half_line = "distance(polyhedron([[3],[0.5]],[2,2]),3)";
  const convex::Function f = samples::function(half_line, 1);
  for (const double x : {-1e6, -13.741, 0.0, 0.5}) CHECK(f(Vector::Constant(1, x)) == 0);
  CHECK(f(Vector::Constant(1, 1)) == doctest::Approx(1).epsilon(1e-12));
  // Points of the half line and of the other meet at every sum.
  const convex::Function sum = samples::function(
      "inf_convolution(" + std::string(half_line) + ",envelope(indicator(orthant()),1))", 1);
  for (const double x : {-13.741, 0.0, 13.741}) CHECK(std::abs(sum(Vector::Constant(1, x))) <= 1e-9);
}

TEST_CASE(
    "beside a domain's edge where the conjugate of 1/x bends without bound, the error counts what members "
    "miss") {
  // Slopes of log(sum exp) are in the simplex, those of 1/x are negative: at y with y_1 + y_2 = 1, y_3 < 0,
  // only one split is left, and the supremum is not attained. It is sum y_i log y_i - 2 sqrt(-y_3).
  const Function f = samples::function("sum(inverse_power(1), log_sum_exp())", 3);
  for (const double first : {1.0, 0.5, 0.25, 0.875})
    for (const double third : {-1.0, -4.0, -0.25, -0.03125}) {
      CAPTURE(first);
      CAPTURE(third);
      const double rest = 1 - first,
                   entropy = first * std::log(first) + (rest > 0 ? rest * std::log(rest) : 0);
      const Value found = f.conjugate().evaluate(Eigen::Vector3d(first, rest, third));
      CHECK(std::abs(found.value - (entropy - 2 * std::sqrt(-third))) <= found.error);
      CHECK(found.error <= 1e-5);
    }
}

TEST_CASE(
    "at a corner of the domain of a conjugate the one split that is left has its value within the error") {
  struct Corner {
    const char* f;
    std::vector<double> at;
    double value;  ///< of the parts at their corners
  };
  for (const Corner& corner : {Corner{"sum(logistic(), scale(max(), 0.5))", {1.5}, 0},
                               {"sum(scale(max(), 0.5), max(), hinge(), logistic())", {2.5}, 0}}) {
    CAPTURE(corner.f);
    const auto n = static_cast<convex::Index>(corner.at.size());
    const Value found =
        samples::function(corner.f, n).conjugate().evaluate(Eigen::Map<const Vector>(corner.at.data(), n));
    CHECK(std::abs(found.value - corner.value) <= found.error);
    CHECK(found.error <= 1e-4);
  }
}

TEST_CASE("a proximal average at a corner of its domain, one part steep there, is told within its error") {
  // p <= 0 and q in the simplex average to x in one way: p = (0, 0, -c), q = (a, 1 - a, 0).
  for (const double t : {0.25, 0.5, 0.75})
    for (const double c : {0.03125, 1.0, 9.0})
      for (const double a : {1.0, 0.25}) {
        CAPTURE(t);
        CAPTURE(c);
        CAPTURE(a);
        const Vector p = Eigen::Vector3d(0, 0, -c), q = Eigen::Vector3d(a, 1 - a, 0);
        const std::string text = "proximal_average(dilate(negative_power(0.5), -1), indicator(simplex(1)), " +
                                 std::to_string(t) + ", 1)";
        const Value found = samples::function(text, 3).evaluate(t * p + (1 - t) * q);
        const double average = -t * std::sqrt(c) + t * (1 - t) / 2 * (p - q).squaredNorm();
        CHECK(std::abs(found.value - average) <= found.error);
        CHECK(found.error <= 1e-4);
      }
}

TEST_CASE("an entry that misses its domain by the rounding of others has the value at the end") {
  // Of x log x and the box [-1, 1]: (x - 1) log(x - 1) beyond 2, 0 at -1.
  const Function f = samples::function("inf_convolution(entropy(), indicator(box(-1, 1)))", 3);
  const auto beyond = [](double x) { return (x - 1) * std::log(x - 1); };
  for (const double miss : {0.0, 1e-15, 2e-13, 1e-12, 1e-11, 1e-10}) {
    CAPTURE(miss);
    const Value found = f.evaluate(Eigen::Vector3d(3e5, -1 - miss, 2e6));
    CHECK(std::abs(found.value - beyond(3e5) - beyond(2e6)) <= found.error);
    CHECK(found.error <= 1e-12 * found.value);
  }
}
