#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "convex/operations/supremum.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Decomposition;
using convex::Function;
using convex::Index;
using convex::Metric;
using convex::Status;
using convex::Value;
using convex::Vector;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Edge {
  const char* f;
  double v, value;
};

/// The sum over entries of a supremum is the supremum of the sum; each value is worked out by hand.
const Edge edges[] = {
    {"sum(log_barrier(), squared_hinge())", -1e-12, -1 - std::log(1e-12)},  // attained at 1e12
    {"sum(inverse_power(1), hinge())", 0, 0},                               // -1/x at infinity
    {"sum(exponential(), indicator(box(-inf, 1)))", 0, 0},                  // -e^x at -infinity
    {"precompose(inverse_power(0.5), [[3],[2]], [3,-3])", 0, 0},
    {"sum(negative_power(0.5), indicator(box(0, 4)))", 0, 2},  // sqrt(x) at 4
    {"sum(norm1(), indicator(box(-1, 1)))", 3, 2},             // 3x - |x| at 1
    {"sum(log_barrier(), hinge())", 0, infinity},              // log x without end
    {"sum(log_barrier(), hinge())", 1e-6, infinity},
    {"sum(exponential(), hinge())", -1.5, infinity},
    {"pointwise_max(exponential(), norm1(2))", 0, -0.70346742249839165},  // where e^x = -2x
};

}  // namespace

TEST_CASE("a supremum that is not attained, or lies at the edge of the domain, has its value") {
  for (const Edge& edge : edges) {
    CAPTURE(edge.f);
    CAPTURE(edge.v);
    const Function f = samples::function(edge.f, 1);
    const Vector v = Vector::Constant(1, edge.v);
    for (const Value& found : {f.conjugate().evaluate(v), convex::supremum(f, v)}) {
      CAPTURE(found.value);
      if (std::isinf(edge.value)) {
        CHECK(found.value == edge.value);
        CHECK(found.error == 0);
      } else {
        CHECK(std::abs(found.value - edge.value) <= 1e-9 * std::max(1.0, std::abs(edge.value)));
        CHECK(found.error <= 1e-9 * std::max(1.0, std::abs(edge.value)));
      }
    }
  }
}

TEST_CASE("the bound of a conjugate's value is true where the split that attains it is at 0 or at no point") {
  // sup of -e^x, of -1/(4|x|) and of -(2/3) / sqrt(3|x|) over x <= 0: 0, which no x attains. A split with
  // parts of 1e-162, whose squares are 0, is outside the half-line's cone all the same.
  for (const char* text :
       {"sum(indicator(halfspace([1], 0)), exponential())",
        "sum(indicator(halfspace([1], 0)), tilt(norm1(), [1]), exponential())",
        "sum(dilate(indicator(orthant()), -1), exponential())",
        "sum(dilate(indicator(orthant()), -1), conjugate(negative_power(0.5)))",
        "sum(dilate(indicator(orthant()), -1), conjugate(negative_power(0.3333333333333333)))"}) {
    CAPTURE(text);
    const Value found = samples::function(text, 1).conjugate().evaluate(Vector::Zero(1));
    CAPTURE(found.value);
    CHECK(std::abs(found.value) <= found.error);
    CHECK(found.error <= 1e-9);
  }
}

TEST_CASE("the bound of a conjugate's value is true where the split that attains it is at a steep end") {
  // Of f + 1/|x|^q where f has the slope 1 far out and no more: f*(1), which no x attains; -1/|x|^q is there.
  struct Case {
    const char* text;
    double value;
  };
  for (const Case& at : {Case{"sum(inverse_power(2), norm1(1))", 0},
                         {"sum(inverse_power(2), huber(1))", 0.5},
                         {"sum(inverse_power(2), logistic())", 0},
                         {"sum(logistic(), inverse_power(2))", 0},
                         {"sum(norm1(1), inverse_power(3))", 0}}) {
    CAPTURE(std::string(at.text));
    const Value found = samples::function(at.text, 1).conjugate().evaluate(Vector{{1}});
    CAPTURE(found.value);
    CHECK(std::abs(found.value - at.value) <= found.error);
    CHECK(found.error <= 1e-9);
  }
}

TEST_CASE("a convolution whose slope is at a steep end of its conjugate has its value at every scale") {
  struct Steep {
    const char* f;
    double (*value)(double);
    double nearest, farthest;  ///< where the value is to be known
  };
  const Steep steep[] = {
      // w = x - 1 in the root, where its slope is below that of the hinge.
      {"inf_convolution(hinge(), inverse_power(0.5))", [](double x) { return 1 / std::sqrt(x - 1); }, 10,
       1e100},
      // Halves of x, by symmetry.
      {"inf_convolution(inverse_power(1), inverse_power(1))", [](double x) { return 4 / x; }, 1e-8, 1e100},
      {"inf_convolution(negative_power(0.5), negative_power(0.5))",
       [](double x) { return -2 * std::sqrt(x / 2); }, 1e-200, 1e200}};
  for (const Steep& question : steep) {
    CAPTURE(std::string(question.f));
    const Function f = samples::function(question.f, 1);
    int known = 0;
    for (const double x : {1e-200, 1e-100, 1e-50, 1e-8, 1.0, 10.0, 1e6, 3e8, 1e16, 1e50, 1e100, 1e200}) {
      CAPTURE(x);
      if (x < question.nearest || x > question.farthest) continue;
      const Value found = f.evaluate(Vector::Constant(1, x));
      const double truth = question.value(x);
      // The exponents of the conjugates are rounded.
      const double rounding = 4e-16 * (1 + std::abs(std::log(x))) * std::abs(truth);
      CHECK(std::abs(found.value - truth) <= found.error + rounding);
      CHECK(found.error <= 1e-11 * std::abs(truth));
      ++known;
    }
    CHECK(known > 5);
  }
}

TEST_CASE("a maximum far from where it is looked for is not missed on values that rounding makes equal") {
  // From the steep end 0 of x log(x/2) - x + 2 on, all doubles up to 1e-17 have the value 2.
  const Function f = samples::function(
      "pointwise_max(pointwise_max(kullback_leibler(2), sum_largest(1)), sum(logistic(), huber(2)))", 1);
  const double v = -1e-12;
  const Value found = f.conjugate().evaluate(Vector::Constant(1, v));
  double least = -2;
  for (double x = 0; x < 1; x += 1e-4) least = std::max(least, v * x - f(Vector::Constant(1, x)));
  CHECK(found.value >= least);
  CHECK(found.value <= least + 2e-4);  // a kink, between steps
  CHECK(found.error <= 1e-12);
}

TEST_CASE("a supremum that is not reached by the search is not told as settled") {
  // 9/(2048 · 3 (x + 1)): the supremum of minus that is 0, at infinity, and the root for each value takes
  // all of the work allowed.
  const Function inverse = samples::function(
      "precompose(perspective(separable(squared_norm2(1/1024), 1, zero(), 1)), [[0], [0], [3]], [3, 2, 3])",
      1);
  const Value at_infinity = inverse.conjugate().evaluate(Vector::Zero(1));
  CHECK(std::abs(at_infinity.value) <= at_infinity.error + 1e-300);
  // 4/x at 1e-200, where the slope -4e400 is no double.
  const Value far = samples::function("inf_convolution(inverse_power(1), inverse_power(1))", 1)
                        .evaluate(Vector::Constant(1, 1e-200));
  CHECK(std::abs(far.value - 4e200) <= far.error);
}

TEST_CASE("what a split tells of a convolution at a steep end agrees with both definitions") {
  const Function f = samples::function("inf_convolution(hinge(), inverse_power(0.5))", 1);
  for (const double z : {1e2, 1e6, 3e8}) {
    CAPTURE(z);
    const Decomposition split = convex::decompose(f, Vector::Constant(1, z), Metric::identity(1));
    const double x = split.x.x[0], y = split.y.x[0];
    CHECK(split.status == Status::solved);
    CHECK(std::abs(split.f_x - 1 / std::sqrt(x - 1)) <= 1e-10 * split.f_x);
    // hinge*(y) = y on [-1, 0], and (x^-1/2)* = -3 (-y/4)^(1/3).
    const double conjugate = y - 3 * std::cbrt(-y / 4);
    CHECK(std::abs(split.g_y - conjugate) <= 1e-10 * std::abs(conjugate));
  }
}

TEST_CASE("an infimum that is not attained is the value of an inf-convolution") {
  // 1/u and log(1 + e^(x-u)), or e^(x-u), both fall to 0 as u grows: the inf-convolution is 0 everywhere.
  for (const char* text :
       {"inf_convolution(inverse_power(1), logistic())", "inf_convolution(inverse_power(1), exponential())",
        "inf_convolution(inverse_power(0.5), distance(halfspace([1,2,2], 3), 0.25))"}) {
    CAPTURE(text);
    const Vector z = Eigen::Vector3d(5, -7.25, 3e-6);
    const Decomposition split = convex::decompose(samples::function(text, 3), z, Metric::identity(3));
    CHECK(std::abs(split.f_x) <= 1e-9);
    CHECK((split.x.x - z).norm() <= std::max(split.error_bound, 1e-12));
  }
}

TEST_CASE("a value that is called solved is borne out by the conjugate's") {
  struct Question {
    const char* f;
    std::vector<double> z;
  };
  for (const Question& question : {
           Question{"inf_convolution(precompose(hinge(), [[0,-1]], [-1]), norm2(0.125))", {-30, 5}},
           {"proximal_average(elastic_net(1024, 0.0009765625), distance(orthant(), 0.001), 0.5, 1)", {50}},
           {"inf_convolution(dilate(inverse_power(1), 0.5), scale(exponential(), 3))",
            {1.5821650203004255e-06, 5}},
           {"sum(dilate(indicator(intersection(polyhedron([[-3],[1]], [6,0]), orthant())), 0.125), "
            "negative_power(0.5))",
            {-0.8117825502118111}},
       }) {
    CAPTURE(question.f);
    const Vector z = Eigen::Map<const Vector>(question.z.data(), static_cast<Index>(question.z.size()));
    const Decomposition split =
        convex::decompose(samples::function(question.f, z.size()), z, Metric::identity(z.size()));
    if (split.status != Status::solved) continue;
    const double size = std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner), 1e-3});
    CHECK(std::abs(split.fenchel_gap) <= 1e-9 * size);
  }
}

TEST_CASE("the prox of an epigraph, which asks its conjugate's, comes to an end") {
  for (const char* text : {"indicator(epigraph(translate(squared_hinge(), [-3])))",
                           "indicator(epigraph(precompose(squared_norm2(1024), [[-2],[-2]], [-2,2])))",
                           "indicator(epigraph(precompose(exponential(), [[2],[-2],[1]], [-2,2,2])))"}) {
    CAPTURE(text);
    const Function f = samples::function(text, 2);
    for (const Vector& z :
         {Vector(Eigen::Vector2d(-6e-6, -3e-6)), Vector(Eigen::Vector2d(-4, 3.742373791716277)),
          Vector(Eigen::Vector2d(5.110769805509885, -3))}) {
      const Decomposition split = convex::decompose(f, z, Metric::identity(2));
      CHECK(split.x.x.size() == 2);
    }
  }
}

TEST_CASE("domains whose closures touch without a common point, and round sets apart, are refused") {
  for (const auto& [text, n] :
       {std::pair{"inf_convolution(log_barrier(), translate(logistic(), [1,1,2]))", 3},
        {"inf_convolution(log_barrier(), logistic())", 1},
        {"indicator(intersection(affine([[0,-3],[1,-3]], [0,0]), ball2(1, [2,2])))", 2},
        {"indicator(intersection(simplex(1024), ball2(1)))", 4},
        {"sum(conjugate(inverse_power(1)), indicator(ball2(1, [1,1])))", 2},
        {"sum(tilt(indicator(ball2(1, [1,-1])), [-3,0]), log_barrier())", 2},
        {"pointwise_max(indicator(ball2(1, [2,3,-1])), inverse_power(0.5))", 3}}) {
    CAPTURE(text);
    CHECK_THROWS_AS(samples::function(text, n), convex::InvalidInput);
  }
}

TEST_CASE("a slope of the least double is a slope") {
  const Function f = samples::function("max_affine([[5e-324,-1]], [0])", 2);
  const Vector z = Eigen::Vector2d(-1.0508025251971551, -2.7071946374139926);
  const Decomposition split = convex::decompose(f, z, Metric::identity(2));
  CHECK(split.status == Status::solved);
  CHECK((split.x.x - Vector(z - Eigen::Vector2d(5e-324, -1))).norm() <= 1e-15);
}

TEST_CASE("a ball that touches a polyhedron meets it in the point of contact") {
  struct Touching {
    const char* f;
    std::vector<double> z, x;
  };
  for (const Touching& at : {
           Touching{"indicator(intersection(box(-1,2), ball2(1,[3,-1])))", {-6, 0}, {2, -1}},
           {"indicator(intersection(orthant(), ball2(1,[2,-1,3])))", {-0.3, -7, -6}, {2, 0, 3}},
           {"indicator(intersection(ball1(1), ball2(1,[2,0])))", {-1, 3}, {1, 0}},
           {"indicator(intersection(ball1(1), ball2(1,[2])))", {-1}, {1}},
           {"indicator(intersection(simplex(1), ball2(0.5)))", {-3, 2, 2, -3}, {0.25, 0.25, 0.25, 0.25}},
       }) {
    CAPTURE(at.f);
    const auto n = static_cast<Index>(at.z.size());
    const Vector z = Eigen::Map<const Vector>(at.z.data(), n), x = Eigen::Map<const Vector>(at.x.data(), n);
    const Decomposition split = convex::decompose(samples::function(at.f, n), z, Metric::identity(n));
    CHECK(split.status == Status::solved);
    CHECK(split.x.x == x);
    CHECK((split.y.x - (z - x)).norm() <= 1e-14 * z.norm());
  }
  // A millionth nearer they meet in a lens, a thousandth high.
  const Vector z{{-6, 0}};
  const Decomposition lens =
      convex::decompose(samples::function("indicator(intersection(box(-1,2.0000009), ball2(1,[3,-1])))", 2),
                        z, Metric::identity(2));
  if (lens.status == Status::solved) CHECK(lens.x.x[1] > -1 + 1e-4);
}

TEST_CASE(
    "f(x) is told of the x that is printed, however steep f is there, and no value stands in for another") {
  // -Σ log of Ax + b, where terms of 1e8 cancel to one of 1.
  const Function steep = samples::function("precompose(log_barrier(), [[-1,0,1,2],[-1,0,-1,2]], [-2,-2])", 4);
  const Vector z{{0, -2e8, 3e8, -3e8}};
  const Decomposition split = convex::decompose(steep, z, Metric::diagonal(Vector{{2, 0.5, 0.5, 0.03125}}));
  const Vector& x = split.x.x;
  const auto by_definition = [&](long double sign) {
    return -std::log(-static_cast<long double>(x[0]) + sign * x[2] + 2 * static_cast<long double>(x[3]) - 2);
  };
  CHECK(split.f_x ==
        doctest::Approx(static_cast<double>(by_definition(1) + by_definition(-1))).epsilon(1e-12));
  // x^-1/2 far out: 1e-4 at 1e8.
  const Function far = samples::function(
      "inf_convolution(pointwise_max(inverse_power(0.5), max_affine([[-3],[-1],[-2]], [3,-3,1])), "
      "translate(hinge(), [-3]))",
      1);
  const Decomposition open = convex::decompose(far, Vector{{1e8}}, Metric::identity(1));
  if (open.status == Status::solved) CHECK(open.f_x == doctest::Approx(1e-4).epsilon(1e-6));
}

TEST_CASE("a value at a point that rounding left outside is that of the edge, not of a better point nearby") {
  // u log u at u = -7.5e-37, made of terms of 3e8: 0, not the -1/e that lies within a part of 1e-9 of them.
  const Function f = samples::function("precompose(entropy(), [[2,-2,-2],[0,2,0]], [-2,0])", 3);
  const Vector x{{145454546.18181819, 3.76158192263132e-37, 145454545.18181819}};
  CHECK(std::abs(f(x)) <= 1e-20);
}

TEST_CASE("at a point that rounds the apex of a perspective, its value is that of the apex") {
  // There |p|³/(3 s²) takes all values above 0.
  const auto f =
      samples::function("precompose(tilt(perspective(power(3)), [3,-3]), [[-1,2,3],[3,-2,3]], [0,-2])", 3);
  const Decomposition split = convex::decompose(f, Vector{{-50, 1, -10}}, Metric::identity(3));
  CHECK(split.status == Status::solved);
  CHECK(std::abs(split.f_x) <= 1e-12);
  CHECK(f.evaluate(split.x.x).error <= 1e-10);
}

TEST_CASE("the conjugate of a maximum of tilted functions is told at slopes next to 0 as at 0") {
  const auto g =
      samples::function(
          "precompose(tilt(pointwise_max(entropy(), negative_power(0.5)), [2,0]), [[-1],[2]], [1,0])", 1)
          .conjugate();
  const Value at_zero = g.evaluate(Vector::Zero(1));
  for (const double v : {-1e-12, 1e-12, -1e-9, 1e-15}) {
    CAPTURE(v);
    CHECK(std::abs(g.evaluate(Vector::Constant(1, v)).value - at_zero.value) <= 1e-11 + std::abs(v));
  }
}

TEST_CASE("a point of a flat side of an epigraph is at the distance 0") {
  const auto f =
      samples::function("distance(epigraph(scale(squared_distance(box(0,inf), 0.0009765625), 3)), 0.125)", 4);
  const Vector z{{2, 2, 0, 0}};
  CHECK(f.evaluate(z).value <= 1e-9);
  CHECK(convex::decompose(f, z, Metric::identity(4)).status == Status::solved);
}

TEST_CASE("a support function is 0 at 0 and keeps the size of the smallest slopes") {
  const auto section = samples::function("conjugate(indicator(intersection(ball2(1), box(-1, 2))))", 2);
  const auto epigraph = samples::function(
      "conjugate(indicator(epigraph(distance(polyhedron([[2,-3],[1,0]], [4,3]), 0.125))))", 3);
  for (const Value& at_zero : {section.evaluate(Vector::Zero(2)), epigraph.evaluate(Vector::Zero(3))}) {
    CHECK(at_zero.value == 0);
    CHECK(at_zero.error == 0);
  }
  for (const double size : {1e-200, 1e-5, 1e200})
    CHECK(section(Vector{{0.6 * size, 0.8 * size}}) == doctest::Approx(size).epsilon(1e-10));
}
