#include <doctest/doctest.h>

#include <cmath>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/composite/atom.hpp"

using convex::Function;
using convex::Metric;
using convex::Space;
using convex::Vector;

namespace {

/// f(x) as another library's tests have it.
struct PeerValue {
  std::string source;
  std::string f;
  std::string x;
  double value;
};

const PeerValue peer_values[] = {
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "norm1(0.6)",
     "[0.004880320993241177,0.3961148017053393,-0.5068003460445393,-0.15461027607226285,-0.526936244339526,0,"
     "-1.2422688010626806,0,-0.2724773673251194,0]",
     1.8624528945256253},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_results.jl", "norm1(0.6)",
     "[0.24488032099324117,0.6361148017053393,-0.7468003460445393,-0.39461027607226284,-0.766936244339526,0."
     "08238242897650354,-1.4822688010626806,0.23915849610266143,-0.5124773673251194,0.14222091048851146]",
     3.148709995866231},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:docs/src/index.md", "norm1(3.5)", "[1,2,3,4,5]", 52.5},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:docs/src/index.md", "norm1(3.5)",
     "[0,0.25,1.25,2.25,3.25]", 24.5},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "total_variation(1)", "[-1,0.0625,0.125,0.1875,0.25,0.3125,0.375,0.4375,0.5,1.4375]", 2.4375},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_optimality_conditions.jl (inputs; outputs "
     "computed here and matched to its KKT test)",
     "total_variation(0.01)",
     "[0.99,0.7777777777777778,0.5555555555555556,0.33333333333333337,0.11111111111111116,-0."
     "11111111111111116,-0.33333333333333326,-0.5555555555555554,-0.7777777777777777,-0.9959999999999999,-0."
     "9959999999999999,-0.9960000000000001,-0.996,-0.996,-0.7777777777777778,-0.5555555555555556,-0."
     "33333333333333337,-0.11111111111111116,0.11111111111111116,0.33333333333333326,0.5555555555555554,0."
     "7777777777777777,0.99]",
     0.039720000000000005},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_gradients.jl",
     "scale(precompose(logistic(), [[-1,0,0,0,0],[0,1,0,0,0],[0,0,-1,0,0],[0,0,0,1,0],[0,0,0,0,-1]], 0), "
     "1.5)",
     "[-1,-2,3,2,1]", 5.893450123044199},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py",
     "precompose(squared_norm2(2), [[8,1,10],[1,9,1],[1.5,3.5,2.5],[0.75,3,3]], [-1,-2,-1.5,-3])", "[1,1,1]",
     455.0625},
    {"epfl-lts2/pyunlocbox@a3ecec3:pyunlocbox/tests/test_functions.py",
     "separable(total_variation(), 2, total_variation(), 2, total_variation(), 2, total_variation(), 2)",
     "[2,22,3,1,0,4,1,5]", 30.0},
    {"ylucet/CCA2@da2c5b9:conjCPLQTest.m", "max_affine([[0,0],[1,0],[0,1],[1,1]], [0,0,0,-1])", "[3,-1]",
     3.0},
    {"ylucet/CCA2@da2c5b9:conjCPLQTest.m", "max_affine([[0,0],[1,0],[0,1],[1,1]], [0,0,0,-1])", "[1,1]", 1.0},
    {"ylucet/CCA2@da2c5b9:conjCPLQTest.m", "max_affine([[0,0],[1,0],[0,1],[1,1]], [0,0,0,-1])", "[-3,-3]",
     0.0},
    {"ylucet/CCA2@da2c5b9:conjCPLQTest.m",
     "conjugate(tilt(indicator(polyhedron([[-1,0],[0,-1],[1,1]], [0,0,1])), [-1,0]))", "[-2,-1]", 0.0},
    {"ylucet/CCA2@da2c5b9:conjCPLQTest.m",
     "conjugate(tilt(indicator(polyhedron([[-1,0],[0,-1],[1,1]], [0,0,1])), [-1,0]))", "[-1,2]", 2.0},
    {"ylucet/CCA2@da2c5b9:infConvTest.m",
     "inf_convolution(quadratic([[2,0],[0,3]]), quadratic([[4,0],[0,1]]))", "[2,-1]", 3.0416666666666665},
    {"ylucet/CCA2@da2c5b9:infConvTest.m",
     "inf_convolution(quadratic([[2,0],[0,3]]), quadratic([[4,0],[0,1]]))", "[1,1]", 1.0416666666666665},
    {"ylucet/CCA2@da2c5b9:moreauTest.m", "envelope(quadratic([[2,0],[0,3]]), 0.5)", "[2,-1]", 2.6},
    {"JuliaPolyhedra/Polyhedra.jl@6849eea:test/support_function.jl",
     "max_affine([[1,0],[0,1],[-1,-1]], [0,0,0])", "[1,1]", 1.0},
};

/// A subgradient of f at x as another library's tests have it.
struct PeerGradient {
  std::string source;
  std::string f;
  std::string x;
  std::string v;
};

const PeerGradient peer_gradients[] = {
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_gradients.jl",
     "envelope(norm2(6), 0.3333333333333333)", "[-1,0.5]", "[-3,1.5]"},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_gradients.jl",
     "quadratic([[2,-1],[-1,2]], [0.1,0.2])", "[3,4]", "[2.1,5.2]"},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_gradients.jl",
     "scale(precompose(logistic(), [[-1,0,0,0,0],[0,1,0,0,0],[0,0,-1,0,0],[0,0,0,1,0],[0,0,0,0,-1]], 0), "
     "1.5)",
     "[-1,-2,3,2,1]",
     "[-1.0965878679450072,0.17880438303317633,-0.07113880976635019,1.3211956169668235,-0.4034121320549927]"},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_gradients.jl", "squared_distance(ball2(1), 2)",
     "[2,-2]", "[2.585786437626905,-2.585786437626905]"},
    {"JuliaFirstOrder/ProximalOperators.jl@ccfc1c0:test/test_gradients.jl",
     "scale(precompose(hinge(), [[1,0,0,0,0],[0,2,0,0,0],[0,0,1,0,0],[0,0,0,2,0],[0,0,0,0,1]], 0), 2)",
     "[-2,-1,0,2,3]", "[-2,-4,-2,0,0]"},
    {"odlgroup/odl@c1fdd54:src/odl/test/solvers/functional/"
     "default_functionals_test.py::test_moreau_envelope_l1",
     "envelope(norm1(), 1)", "[-3,2,10]", "[-1,1,1]"},
};

/// The conjugate (or another transform) of a function of one variable, as a function of one variable.
struct PeerEquation {
  std::string source;
  std::string left;
  std::string right;
};

const PeerEquation peer_equations[] = {
    {"ylucet/CCA@2e0b2cd:tests/plq_lft_test.m::testQQSmooth", "conjugate(plq([-2], [[2,1,1],[2,1,1]]))",
     "plq([], [[0.5,-0.5,-0.75]])"},
    {"ylucet/CCA@2e0b2cd:tests/plq_lft_test.m::testL", "conjugate(plq([], [[0,1,1]]))",
     "sum(indicator(point([1])), constant(-1))"},
    {"ylucet/CCA@2e0b2cd:tests/plq_lft_test.m::testNormSquared", "conjugate(plq([], [[1,0,0]]))",
     "plq([], [[1,0,0]])"},
    {"ylucet/CCA@2e0b2cd:tests/plq_lft_test.m::testQLQSmooth",
     "conjugate(plq([1,3], [[2,0,0],[0,2,-1],[6,-16,26]]))",
     "plq([2], [[0.5,0,0],[0.16666666666666666,2.6666666666666665,-4.666666666666667]])"},
    {"ylucet/CCA@2e0b2cd:tests/plq_lft_test.m::testPLQboundedLHS",
     "conjugate(plq([-5], [[inf,0,0],[2,0,5]]))", "plq([-10], [[0,-5,-30],[0.5,0,-5]])"},
    {"ylucet/CCA@2e0b2cd:tests/plq_me_test.m::testMEQuadraticWrapper", "envelope(plq([], [[1,0,0]]), 1)",
     "plq([], [[0.5,0,0]])"},
    {"ylucet/CCA@2e0b2cd:tests/plq_pa_test.m::testI2Ipa",
     "proximal_average(sum(indicator(point([6])), constant(4)), sum(indicator(point([5])), constant(1)), "
     "0.5, 1)",
     "sum(indicator(point([5.5])), constant(2.625))"},
    {"ylucet/CCA@2e0b2cd:tests/plq_conv_test.m::testInfconvLft",
     "inf_convolution(plq([], [[0.5,0,0]]), plq([], [[2,0,0]]))", "plq([], [[0.4,0,0]])"},
    {"ylucet/CCA@2e0b2cd:tests/plq_max_test.m::testQLQ2Max",
     "pointwise_max(plq([0], [[0,-2,0],[0,2,0]]), plq([0], [[0,-1,1],[0,1,1]]))",
     "plq([-1,0,1], [[0,-2,0],[0,-1,1],[0,1,1],[0,2,0]])"},
    {"ylucet/CCA@2e0b2cd:tests/plq_max_test.m::testQLMax",
     "pointwise_max(plq([], [[2,0,0]]), plq([], [[0,0,1]]))", "plq([-1,1], [[2,0,0],[0,0,1],[2,0,0]])"},
};

Function made(const std::string& text, convex::Index n) {
  return convex::make_function(cli::parse_call(text, "f"), Space{Metric::identity(n)});
}

Vector vector(const std::string& text) { return cli::parse_vector(text, "vector"); }

}  // namespace

TEST_CASE("values in other libraries' tests are found") {
  for (const PeerValue& peer : peer_values) {
    CAPTURE(peer.source);
    CAPTURE(peer.f);
    const Vector x = vector(peer.x);
    CHECK(std::abs(made(peer.f, x.size())(x) - peer.value) <= 1e-14 * (1 + std::abs(peer.value)));
  }
}

TEST_CASE("gradients in other libraries' tests are subgradients") {
  for (const PeerGradient& peer : peer_gradients) {
    CAPTURE(peer.source);
    CAPTURE(peer.f);
    const Vector x = vector(peer.x), v = vector(peer.v);
    const Function f = made(peer.f, x.size());
    CHECK(f.is_subgradient(v, x));
    CHECK(!f.is_subgradient(v + Vector::Constant(v.size(), 1e-3), x));
    REQUIRE(f.subgradient(x));
    CHECK((*f.subgradient(x) - v).norm() <= 1e-14 * v.norm());
  }
}

TEST_CASE("transforms of functions of one variable in other libraries' tests are the functions they say") {
  for (const PeerEquation& peer : peer_equations) {
    CAPTURE(peer.source);
    CAPTURE(peer.left);
    const Function left = made(peer.left, 1), right = made(peer.right, 1);
    for (double at = -12; at <= 12; at += 0.25) {
      const Vector x = Vector::Constant(1, at);
      CAPTURE(at);
      const double a = left(x), b = right(x);
      if (std::isinf(b))
        CHECK(a == b);
      else
        CHECK(std::abs(a - b) <= 1e-13 * (1 + std::abs(b)));
    }
  }
}

TEST_CASE(
    "functions that other libraries take although they are not convex, or +inf everywhere, are refused") {
  for (
      std::string text : {
          "plq([-1,0,1], [[0,-1,-1],[0,1,1],[0,-1,1],[0,1,-1]])",  // ylucet/CCA@2e0b2cd:tests/plq_lft_test.m::testNonconvex
                                                                   // (envelope first)
          "plq([-1,1,4], [[inf,0,0],[0,1,-1],[0,0,0],[inf,0,0]])",  // ylucet/CCA@2e0b2cd:tests/plq_coSplit_test.m::testL2Lch_1
          "plq([0,2], [[0,1,0],[0,0,0],[2,-4,4]])",  // ylucet/CCA@2e0b2cd:tests/plq_coSplit_test.m::testL2L2Qch_7
          "plq([-3,0,3], [[2,8,16],[0,-1,-2],[0,1,-2],[2,-8,16]])",  // ylucet/CCA@2e0b2cd:tests/plq_coSplit_test.m::testQ2L2L2Qch_11
          "sum(indicator(point(1)), indicator(point(2)))",  // ylucet/CCA@2e0b2cd:tests/plq_add_Test.m::testIPlusI2
      }) {
    CAPTURE(text);
    CHECK_THROWS_AS(made(text, 1), convex::InvalidInput);
  }
}

TEST_CASE("the derivative of the projection on the second-order cone is the one in print") {
  // MathOptSetDistances.jl@815c9fd, test/projections.jl, at (0,1,1,1,1) with the bound first.
  const Function cone = made("second_order_cone()", 5);
  const auto* atom = dynamic_cast<const convex::Atom*>(&cone.node());
  REQUIRE(atom);
  Vector z(5);
  z << 1, 1, 1, 1, 0;
  convex::Matrix expected = 0.5 * convex::Matrix::Identity(5, 5);
  expected.row(4).head(4).setConstant(0.25);
  expected.col(4).head(4).setConstant(0.25);
  CHECK((convex::Matrix(atom->prox_jacobian(z, Vector::Ones(5))) - expected).norm() <= 1e-15);
}
