#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/functions/decomposition.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/infinity.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Function;
using convex::Value;
using convex::Vector;
using convex::WorkLimit;

namespace {

const char* const mean_of_two = "proximal_average(huber(2), power(3), 0.5, 0.5)";

}  // namespace

TEST_CASE("a value for which no work is left is open, however little has been found of it") {
  const Function f = samples::function(mean_of_two, 1);
  for (const double x : {-1.0, -0.1, 3.0}) {
    const Vector at = Vector::Constant(1, x);
    const double truth = f.evaluate(at).value;
    const WorkLimit question;
    while (!WorkLimit::passed()) WorkLimit::count(1000);
    const Value found = f.node().evaluate(at);
    CAPTURE(x);
    CAPTURE(found.value);
    CHECK(truth > 1e-3);
    CHECK((std::isinf(found.error) || std::abs(found.value - truth) <= found.error + 1e-12 * truth));
  }
}

TEST_CASE("a value is open where the work ends, however thin the domain of the conjugate is along the axes") {
  const Function f = samples::function(
      "inf_convolution(distance(ball2(1), 3), scale(perspective(squared_norm2(1024)), 0.0009765625))", 2);
  for (const Vector& x : {Vector{{2, 0}}, Vector{{1.32134, 0.230293}}}) {
    const double truth = f.evaluate(x).value;
    const WorkLimit question(1e-5);
    const Value found = f.evaluate(x);
    CAPTURE(found.value);
    CHECK(truth > 0.1);
    CHECK((std::isinf(found.error) || std::abs(found.value - truth) <= found.error + 1e-12));
  }
}

TEST_CASE(
    "a value is open where the work ends on a cone so thin that no point beside its tip is seen in it") {
  struct Question {
    const char* f;
    Vector v;
    double least;  // v·x - f(x) at a point of the cone
    double part;
  };
  const Question questions[] = {
      // At x = 4000 (-2, -1, 3, 0.5).
      {"sum(precompose(epigraph(norm2()), [[82,-16,48,8],[-16,106,24,4],[48,24,42,-12],[8,4,-12,112],"
       "[-2,-1,3,0.5]]), total_variation(), log_sum_exp())",
       Vector{{-3, -1, 5.5, -0.3125}}, 10000, 1e-5},
      // At x = (0, 2, 0.5, -2).
      {"pointwise_max(sum(precompose(epigraph(norm1()), "
       "[[1107296256,0,0,0],[0,570425344,-134217728,536870912],[0,-134217728,1073741824,134217728],"
       "[0,536870912,134217728,570425344],[0,2,0.5,-2]]), norm_inf()), log_sum_exp())",
       Vector{{0.18621326564823665, 2.5061801362296188, 0.7391025660167622, -1.9314959678946173}}, 6, 1e-2},
      // At x = (-2, 1, -1.5) / |(-2, 1, -1.5)|.
      {"sum(precompose(epigraph(norm_inf()), [[53248,32768,-49152],[32768,102400,24576],[-49152,24576,81920],"
       "[-2,1,-1.5]]), distance(ball2(1), 3))",
       Vector{{-2.2283440581246223, 1.1141720290623112, -1.6712580435934667}}, 2.9, 1e-7},
  };
  for (const Question& asked : questions) {
    const Function g = samples::function(asked.f, asked.v.size()).conjugate();
    const WorkLimit question(asked.part);
    const Value found = g.evaluate(asked.v);
    CAPTURE(asked.f);
    CAPTURE(found.value);
    CAPTURE(found.error);
    CHECK(found.value + found.error >= asked.least);
  }
}

TEST_CASE("a point beside a cone thinner than the membership tolerance is split on its axis") {
  const Vector u{{0.5, 2, 3}};
  const std::string cone =
      "precompose(second_order_cone(), "
      "[[1744830464,-134217728,-201326592],[-134217728,1241513984,-805306368],"
      "[-201326592,-805306368,570425344],[0.5,2,3]])";
  struct Question {
    const char* norm;
    double height;  // of z = (0, 0, height)
    double along;   // the norm of u
  };
  for (const Question& asked :
       {Question{"norm2()", 2, u.norm()}, {"norm_inf()", 1.5, 3}, {"norm1()", 2, 5.5}}) {
    CAPTURE(asked.norm);
    const Function f = samples::function("sum(" + cone + ", " + asked.norm + ")", 3);
    const Vector z{{0, 0, asked.height}};
    const auto split = convex::decompose(f, z, convex::Metric::identity(3));
    const Vector x = (z.dot(u) - asked.along) / u.squaredNorm() * u;
    CHECK(split.status == convex::Status::solved);
    CHECK((split.x.x - x).norm() <= 1e-8);
    const Value outside = f.conjugate().evaluate(z);
    CHECK((std::isinf(outside.value) || std::isinf(outside.error)));
  }
  const Function f = samples::function(
      "sum(precompose(second_order_cone(), [[1000000000000,-1000000000000],[1,1]]), norm1())", 2);
  const Value outside = f.conjugate().evaluate(Vector{{1, 3}});
  CHECK((std::isinf(outside.value) || std::isinf(outside.error)));
}

TEST_CASE("the bound of a split holds where values beside the domain of the conjugate are not known") {
  // x = 2^-41 (0.5, 2, 3), z = x + (0, 0, 1), whose conjugate is +inf.
  const Function f = samples::function(
      "sum(precompose(second_order_cone(), [[1744830464,-134217728,-201326592],[-134217728,1241513984,"
      "-805306368],[-201326592,-805306368,570425344],[0.5,2,3]]), norm_inf())",
      3);
  const Vector x = std::ldexp(1.0, -41) * Vector{{0.5, 2, 3}};
  const auto split = convex::decompose(f, x + Vector{{0, 0, 1}}, convex::Metric::identity(3));
  CHECK((split.x.x - x).norm() <= split.error_bound);
}

TEST_CASE("the conjugate of a maximum at a slope that is almost 0 is no less than its lower bounds") {
  const std::string text = "pointwise_max(" + std::string(mean_of_two) + ", tilt(constant(1), [3]))";
  const Function f = samples::function(text, 1), g = f.conjugate();
  for (const double v : {1e-12, -1e-12, 1e-11, 1e-9}) {
    CAPTURE(v);
    const Value found = g.evaluate(Vector::Constant(1, v));
    CHECK(found.error <= 1e-9);
    for (const double x : {-1.0, -0.5, -0.3236, -0.25, 0.0, 1.0})
      CHECK(found.value >= v * x - f(Vector::Constant(1, x)) - 1e-9);
  }
}

TEST_CASE("the conjugate of a support function is 0 or inf, and open within the membership tolerance") {
  // Beyond the domain by 5e-11, where lower bounds grow without end.
  for (const char* text :
       {"sum(norm1(), total_variation(0.5))", "pointwise_max(norm1(), total_variation(1.25))"}) {
    CAPTURE(text);
    const Function g = samples::function(text, 3).conjugate();
    for (const double beyond : {5e-11, 1e-10, 3e-10, 1e-6}) {
      CAPTURE(beyond);
      const Value found = g.evaluate(Vector{{1.5 + beyond, -1, -1.5 - beyond}});
      CHECK((found.value == 0 || found.value == convex::infinity));
      CHECK((found.value > 0 || std::isinf(found.error)));
    }
  }
}

TEST_CASE("the supremum of a function that leaves the range of doubles far out is found nearer") {
  const Function f = samples::function(
      "tilt(sum(logistic(), exponential(), dilate(max_affine([[0.1],[0.1],[0.10000000001],[-1]], "
      "[4,3.0000029999999995,-0.001,-0.6999999929999999]), -1.000001e-08)), [1.9999999999999996])",
      1);
  // In fifty digits, at 2.
  const Value found = f.conjugate().evaluate(Vector::Constant(1, 99999910.26995333));
  CHECK(std::abs(found.value - 7.72372253577232) <= found.error);
  CHECK(found.error <= 1e-5);
}

TEST_CASE("a conjugate is 0 between the slopes of a kink at which a power bends without bound") {
  // max(-x, x²/2) + |x|^p/p + x²/2 >= v x for v in [-1, 0], with equality at 0.
  for (const char* p : {"1.5", "1.75", "3"})
    for (double v : {-0.3, -0.34375, -0.9}) {
      CAPTURE(p);
      CAPTURE(v);
      const std::string f =
          std::string("sum(pointwise_max(linear([-1]), squared_norm2()), power(") + p + "), squared_norm2())";
      const Value found = samples::function(f.c_str(), 1).conjugate().evaluate(Vector::Constant(1, v));
      CHECK(std::abs(found.value) <= found.error);
      CHECK(found.error <= 1e-20);
    }
}
