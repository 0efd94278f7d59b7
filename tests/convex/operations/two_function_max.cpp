#include "convex/operations/two_function_max.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "convex/functions/piecewise_functions.hpp"
#include "convex/functions/sets.hpp"
#include "convex/gamma0/work_limit.hpp"
#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Decomposition;
using convex::Function;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Prox;
using convex::Status;
using convex::Value;
using convex::Vector;

TEST_CASE("the dual of a maximum in one number finds the prox that epigraphs find") {
  int compared = 0;
  for (const auto& [first, second] : {std::pair{"power(2)", "exponential()"},
                                      {"squared_norm2(3)", "norm1(2)"},
                                      {"logistic()", "squared_distance(ball2(1), 2)"},
                                      {"log_barrier()", "hinge()"},
                                      {"indicator(box(-1, 2))", "power(3)"}}) {
    CAPTURE(std::string(first) + ", " + second);
    const Function f = samples::function(first, 3), g = samples::function(second, 3);
    const Function both = samples::function(std::string("pointwise_max(") + first + ", " + second + ")", 3);
    for (const Metric& W : samples::metrics(3))
      for (const Vector& z : samples::points(3)) {
        CAPTURE(z.transpose());
        const auto found = convex::prox_of_two_function_max(f, g, z, W);
        const Prox expected = both.prox(z, W);
        if (!found || found->error_bound > 1e-9 || expected.error_bound > 1e-9) continue;
        CHECK(W.norm(found->x - expected.x) <= 2 * (found->error_bound + expected.error_bound));
        ++compared;
      }
  }
  CHECK(compared > 100);
}

TEST_CASE("where one function is above the other at its prox, its prox is that of the maximum") {
  const Function f = samples::function("squared_norm2(1)", 2), g = samples::function("norm2(1)", 2);
  const Vector near = Eigen::Vector2d(0.3, 0.4), far = Eigen::Vector2d(30, 40);
  const auto of_norm = convex::prox_of_two_function_max(f, g, near, Metric::identity(2));
  const auto of_square = convex::prox_of_two_function_max(f, g, far, Metric::identity(2));
  REQUIRE(of_norm);
  REQUIRE(of_square);
  CHECK(of_norm->x == Vector(Vector::Zero(2)));
  CHECK((of_square->x - far / 2).norm() <= 1e-14 * far.norm());
}

TEST_CASE("one function above the others at its prox is found so however far an entry is") {
  // The entropies are above -5, so that the maximum is their own: 0 = x + 1 + log x at the near entry.
  const double near = 0.27846454276107379;  // W(1/e)
  for (double far : {1e6, 1e8, 1e9, 1e10, 1e12}) {
    CAPTURE(far);
    const Prox found = samples::function("pointwise_max(entropy(), constant(-5))", 2)
                           .prox(Eigen::Vector2d(0, -far), Metric::identity(2));
    CHECK(found.status == convex::Status::solved);
    CHECK(std::abs(found.x[0] - near) <= 1e-15);
    CHECK(found.x[1] == 0);
  }
}

TEST_CASE("between the two it is where they are equal") {
  // Points of length 3 to 4 have their prox at length 2, where r²/2 = r.
  const Function f = samples::function("squared_norm2(1)", 2), g = samples::function("norm2(1)", 2);
  for (const double length : {3.001, 3.5, 3.999}) {
    CAPTURE(length);
    const Vector z = length * Eigen::Vector2d(0.6, 0.8);
    const auto found = convex::prox_of_two_function_max(f, g, z, Metric::identity(2));
    REQUIRE(found);
    CHECK((found->x - Eigen::Vector2d(1.2, 1.6)).norm() <= found->error_bound + 1e-15);
    CHECK(found->error_bound <= 1e-12);
  }
}

TEST_CASE("where one function is nearly +inf at the other's prox, a small weight of it makes them equal") {
  const Vector z = Eigen::Vector3d(2, -5e-6, -2);
  const Metric W = Metric::diagonal(Eigen::Vector3d(0.03125, 1, 10));
  const Function f = samples::function("scale(logistic(), 3)", 3);
  const Function g = samples::function("perspective(squared_distance(affine([[-1,3]], 0), 3))", 3);
  const auto found = convex::prox_of_two_function_max(f, g, z, W);
  const auto reversed = convex::prox_of_two_function_max(g, f, z, W);
  REQUIRE(found);
  REQUIRE(reversed);
  CHECK(found->error_bound <= 1e-11);
  CHECK(reversed->error_bound <= 1e-11);
  CHECK(W.norm(found->x - reversed->x) <= found->error_bound + reversed->error_bound);
  CHECK(std::abs(f(found->x) - g(found->x)) <= 1e-6 * f(found->x));  // g' is 1e6 there
  // v is a mean of both slopes: f's alone is not W(z - x), and g's alone is not.
  const Vector of_f = *f.subgradient(found->x), of_g = *g.subgradient(found->x), v = W.multiply(z - found->x);
  const double t = (v - of_f).dot(of_g - of_f) / (of_g - of_f).squaredNorm();
  CHECK(t > 0);
  CHECK(t < 1e-3);
  CHECK((v - of_f - t * (of_g - of_f)).norm() <= 1e-6 * v.norm());
}

TEST_CASE("the programs that the dual of a maximum asks count as work") {
  const Function f =
      samples::function("pointwise_max(quadratic([[1,0],[0,2]], [-3,2]), squared_norm2(0.25))", 2);
  const convex::WorkLimit question(1e-3);
  convex::prox_of_two_function_max(convex::parts_of_max(f)[0], convex::parts_of_max(f)[1], Vector{{2, 5}},
                                   Metric::identity(2));
  CHECK(convex::WorkLimit::passed());
}

TEST_CASE("the search for a weight ends where no mean between two weights has a prox") {
  const Function f = samples::function("inf_convolution(log_sum_exp(), norm2())", 2),
                 g = samples::function("sum(inf_convolution(huber(0.5), norm2(3)), norm_inf())", 2);
  const Vector z = Vector::Zero(2);
  const convex::WorkLimit question(0.1);
  const auto found = convex::prox_of_two_function_max(f, g, z, Metric::identity(2));
  CHECK_FALSE(convex::WorkLimit::passed());
  CHECK((!found || found->error_bound <= 1e-9));
}

TEST_CASE("where one of two functions is the maximum, its own conjugate tells that of the maximum") {
  // The other's epigraph, 1e8 far out, hides 6e-7 of the least entry.
  const Function f = samples::function("pointwise_max(squared_hinge(), inverse_power(0.5))", 2);
  const auto W = Metric::diagonal(Vector{{2, 10}});
  const auto split = convex::decompose(f, Vector{{1e8, -1e8}}, W);
  CHECK(split.status == convex::Status::solved);
  const double least = split.x.x[1], slope = 0.5 / (least * std::sqrt(least));
  CHECK(split.g_y == doctest::Approx(-1 / std::sqrt(least) - slope * least).epsilon(1e-6));
}

TEST_CASE("the conjugate of a maximum is known by its dual where slopes are far apart") {
  // (max(l, indicator of B))* is the least of the support function of B at v - (1 - t) l, here at t = 0,
  // where it is |w| + w_1 - w_2, w = v - l.
  const Function parts[] = {convex::linear(Vector{{-3, -1}}), convex::ball2(1, Vector{{1, -1}}).indicator};
  const Function g = pointwise_max(parts).conjugate();
  for (const double far : {3e3, 3e5, 3e8}) {
    const double a = far - 3, truth = 9 / (std::hypot(a, 3) + a) - 3;
    const Value found = g.evaluate(Vector{{-far, 2}});
    CAPTURE(far);
    CHECK(std::abs(found.value - truth) <= found.error + convex::unit_roundoff * std::abs(truth));
    CHECK(found.error <= 4 * convex::unit_roundoff * far);  // of v·x, which cancels
  }
}

TEST_CASE("a maximum is known though the conjugate of its mean with the least weight is not") {
  struct Case {
    const char* box;
    double x;
  };
  for (const Case& one : {Case{"box(13,15)", 13}, {"box(-3,-2)", -2}, {"box(25,30)", 25}}) {
    CAPTURE(std::string(one.box));
    const Function f = samples::function(
        "pointwise_max(sum(huber(1), indicator(" + std::string(one.box) + ")), squared_norm2())", 1);
    const Decomposition split = decompose(f, Vector::Constant(1, 5), Metric::identity(1));
    CHECK(split.status == Status::solved);
    CHECK(split.x.x[0] == doctest::Approx(one.x).epsilon(1e-13));
  }
}

TEST_CASE("the bound of a maximum's prox counts what its proxes miss in badly scaled metrics") {
  struct Case {
    const char *f, *g;
    Vector z;
    Matrix W;
    Vector x;  // by Newton's method in fifty digits, from an x and a mean of slopes there
  };
  const Case cases[] = {
      {"scale(power(1.5), 0.8280550636124414)", "scale(norm1(), 1.2881972524173966)",
       Vector{{-233650900.61091956, -1207921385.0561144, 2316397082217.622, -13402856.62637654}},
       Matrix{
           {1.9456296163588615e-06, 4.17435254611336e-08, 1.9179042386726884e-10, -4.629345305048714e-06},
           {4.17435254611336e-08, 2.501524955153965e-08, 1.7023336984893343e-11, -1.3618315192635733e-07},
           {1.9179042386726884e-10, 1.7023336984893343e-11, 5.884850170574471e-13, 7.165252226783392e-10},
           {-4.629345305048714e-06, -1.3618315192635733e-07, 7.165252226783392e-10, 0.00021690861151910947}},
       Vector{{2.031199488872334, 0.017733757488930392, 0.10829542485282401, -2.896082870039481}}},
      {"scale(norm1(), 9.879598943726824)", "sum(log_barrier(), constant(3.232180794711173))",
       Vector{{-278198597102.20996, -108041466562.14397, 195820828057.25415}},
       Matrix{{0.20179383064500372, 0.08958261025893524, 0.3361102996209631},
              {0.08958261025893524, 0.03978576405253052, 0.1492194066117213},
              {0.3361102996209631, 0.1492194066117213, 0.5598347144908409}},
       Vector{{0.04308373067404775, 8.217942002653364e-06, 1.7319529520284287}}},
      {"huber(0.5)", "scale(exponential(), 0.02901265705826523)",
       Vector{{1760.7016841188909, 8971273.368196877}},
       Matrix{{1.0678195886027337, -0.00020943644079420297},
              {-0.00020943644079420297, 2.262914562193353e-07}},
       Vector{{0.43549434051397284, 5.160452885552077}}},
  };
  for (const Case& one : cases) {
    CAPTURE(std::string(one.f) + ", " + one.g);
    const Index n = one.z.size();
    const Metric W = Metric::dense(one.W);
    const auto found =
        convex::prox_of_two_function_max(samples::function(one.f, n), samples::function(one.g, n), one.z, W);
    REQUIRE(found);
    CHECK(W.norm(found->x - one.x) <= found->error_bound);
    CHECK(found->error_bound <= 1e-8 * W.norm(one.z));
  }
}
