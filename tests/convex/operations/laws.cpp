#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/operations/metric_algebra.hpp"
#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Function;
using convex::Index;
using convex::Metric;
using convex::Prox;
using convex::Status;
using convex::Vector;

namespace {

/// Two routes to one point agree to so much of the scale in these metrics of condition about 20.
constexpr double two_routes = 2e-12;

/// f(x) + f*(v) - x·v vanishes to so much of its terms.
constexpr double conjugacy = 1e-10;

/// Expressions of three entries whose conjugate is a rule, and those for which it is computed.
const std::vector<std::string> expressions = {
    "translate(norm1(2), [1,-2,0.5])",
    "tilt(norm2(), [0.5,-0.25,0.5])",
    "tilt(indicator(box(-1, 1)), [0.5,0,-2])",
    "scale(huber(0.1), 0.25)",
    "scale(dilate(logistic(), -2), 3)",
    "dilate(hinge(), -2)",
    "translate(tilt(scale(dilate(translate(huber(0.5), [1,2,3]), 3), 0.2), [0.1,0,0.2]), [1,0,-1])",
    "sum(norm1(), squared_norm2(2))",
    "sum(norm2(), quadratic([[2,1,0],[1,2,0],[0,0,1]], [1,0,-1]))",
    "sum(norm1(), quadratic([[1,1,0],[1,1,0],[0,0,0]]), linear([0.5,0,0]))",
    "sum(norm2(), indicator(box(-1, 2)))",
    "sum(norm1(), total_variation(0.5), constant(3))",
    "sum(quadratic([[2,1,0],[1,2,0],[0,0,1]]), linear([1,2,3]), constant(-1))",
    "sum(logistic(), norm2())",
    "inf_convolution(norm1(), squared_norm2(2))",
    "inf_convolution(norm2(), quadratic([[2,1,0],[1,2,0],[0,0,1]], [1,0,-1]))",
    "inf_convolution(norm2(), norm1(0.75))",
    "inf_convolution(huber(1), indicator(ball2(0.5)))",
    "envelope(norm1(), 0.5)",
    "envelope(indicator(ball2()), 2)",
    "envelope(envelope(entropy(), 0.25), 1)",
    "precompose(norm1(), [[1,1,0],[0,1,-1]])",
    "precompose(norm2(), [[0,1,0],[0,0,1],[1,0,0]], [1,2,3])",
    "precompose(huber(1), [[2,0,0],[0,-1,0],[0,0,3]], [1,0,0])",
    "precompose(norm1(), [[1,1,0],[0,1,-1],[1,2,-1],[1,0,0],[0,0,1]], [1,0,0,1,-1])",
    "precompose(logistic(), [[1,2,0],[0,1,1],[1,0,1],[2,1,1]], [1,0,-1,0])",
    "precompose(norm2(), [[3,4,0],[-4,3,0]], [1,0])",
    "separable(norm1(), 1, norm2(), 2)",
    "separable(entropy(), 2, indicator(orthant()), 1)",
    "pointwise_max(norm1(), linear([1,2,-3]))",
    "pointwise_max(norm2(), constant(1))",
    "pointwise_max(squared_norm2(), norm1(2))",
    "proximal_average(norm1(), squared_norm2(), 0.25, 1)",
    "proximal_average(norm2(), indicator(box(-1, 1)), 0.5, 2)",
    "perspective(squared_norm2())",
    "perspective(norm1())",
    "indicator(epigraph(norm1()))",
    "indicator(epigraph(squared_norm2()))",
    "indicator(intersection(ball2(1), box(0, 2)))",
    "distance(ball2())",
    "distance(box(-1, 1), 2)",
    "squared_distance(box(-1, 1), 2)",
    "conjugate(sum(norm2(), hinge()))",
    "conjugate(pointwise_max(norm1(), linear([1,2,-3])))",
};

/// Where z and x vanish a bound of rounding is no part of their size.
bool solved(const Prox& p) { return p.status == Status::solved || p.error_bound <= 1e-14; }

double size(const Metric& W, const Vector& z, const Vector& x) { return W.norm(z) + W.norm(x) + 1; }

}  // namespace

TEST_CASE("z is the sum of the proxes of f and of its conjugate, each found by itself") {
  for (const std::string& text : expressions) {
    CAPTURE(text);
    const Function f = samples::function(text, 3), g = f.conjugate();
    for (const Metric& W : samples::metrics(3))
      for (const Vector& z : samples::points(3)) {
        CAPTURE(z.transpose());
        CAPTURE(static_cast<int>(W.kind()));
        const Prox of_f = f.prox(z, W), of_g = g.prox(W.multiply(z), convex::inverse(W));
        CHECK(solved(of_f));
        CHECK(solved(of_g));
        const double gap = W.norm(of_f.x + W.solve(of_g.x) - z);
        CHECK(gap <= two_routes * size(W, z, of_f.x));
        CHECK(gap <= 2 * (of_f.error_bound + of_g.error_bound) + 1e-13 * size(W, z, of_f.x));
        CHECK(of_f.error_bound <= 1e-11 * size(W, z, of_f.x));
      }
  }
}

TEST_CASE("at a prox the covector and the point are conjugate, and no other point does better") {
  for (const std::string& text : expressions) {
    CAPTURE(text);
    const Function f = samples::function(text, 3), g = f.conjugate();
    for (const Vector& z : samples::points(3)) {
      CAPTURE(z.transpose());
      const Prox p = f.prox(z, Metric::identity(3));
      const double at_x = f(p.x), at_v = g(p.v);
      const double scale = 1 + std::abs(at_x) + std::abs(at_v) + p.x.norm() * p.v.norm();
      CHECK(std::abs(at_x + at_v - p.x.dot(p.v)) <= conjugacy * scale);
      for (const Vector& u : samples::points(3))
        CHECK(f(u) + at_v >= u.dot(p.v) - conjugacy * (scale + u.norm()));
      for (const Vector& w : samples::points(3))
        CHECK(at_x + g(w) >= p.x.dot(w) - conjugacy * (scale + w.norm()));
    }
  }
}

TEST_CASE("an inf-convolution is finite where a part of its minimiser is 0 to rounding") {
  const Function f = samples::function("inf_convolution(norm2(), support(box(0,2)))", 1);
  for (double x : {0.1, 0.5, 1.7, 1e-3, 1e9})
    CHECK(f(Vector::Constant(1, x)) == doctest::Approx(x).epsilon(1e-14));
}

TEST_CASE("a conjugate by rule has the values of the one that is computed") {
  for (const std::string& text : expressions) {
    CAPTURE(text);
    const Function f = samples::function(text, 3), rule = f.conjugate(),
                   computed = convex::computed_conjugate(f);
    // Without a rule the two are one; the support of an intersection has none of its own.
    if (rule.call().name == computed.call().name || text.find("intersection") != std::string::npos) continue;
    for (const Vector& z : samples::points(3)) {
      const Vector v = rule.prox(z, Metric::identity(3)).x;
      CAPTURE(v.transpose());
      const double expected = computed(v);
      CHECK(std::abs(rule(v) - expected) <= 1e-9 * (1 + std::abs(expected) + v.norm()));
    }
  }
}

TEST_CASE("the text of a conjugate reads back to the same function") {
  for (const std::string& text : expressions) {
    CAPTURE(text);
    const Function g = samples::function(text, 3).conjugate();
    CAPTURE(to_text(g.call()));
    const Function again = samples::function(to_text(g.call()), 3);
    for (const Vector& z : samples::points(3)) {
      const Prox p = g.prox(z, Metric::identity(3)), q = again.prox(z, Metric::identity(3));
      CHECK((p.x - q.x).norm() <= 1e-11 * (1 + z.norm()));
    }
  }
}

TEST_CASE("the conjugate of a conjugate by rule is written as the function was") {
  for (const char* text :
       {"translate(norm1(), by=[1,-2,0.5])", "tilt(norm1(), c=[1,-2,0.5])", "scale(huber(mu=0.5), alpha=3)",
        "dilate(huber(mu=0.5), rho=-4)", "scale(dilate(huber(mu=0.5), rho=49), alpha=7)",
        "translate(tilt(norm1(), c=[1,2,3]), by=[0,1,0])", "separable(norm1(), 1, norm2(), 2)"}) {
    const Function f = samples::function(text, 3);
    CHECK(to_text(f.conjugate().conjugate().call()) == to_text(f.call()));
  }
}

TEST_CASE("the conjugate in a product is the supremum of that product, and splits a point in its metric") {
  for (const std::string& text : expressions) {
    CAPTURE(text);
    const Metric W = samples::dense(3, 4);
    const Function f = samples::function(text, W), g = samples::function("conjugate(" + text + ")", W);
    for (const Vector& z : samples::points(3)) {
      CAPTURE(z.transpose());
      const Prox p = f.prox(z, W), q = g.prox(z, W);
      CHECK(W.norm(p.x + q.x - z) <= two_routes * size(W, z, p.x));
      const double at_x = f(p.x), at_y = g(q.x), inner = W.inner(p.x, q.x);
      CHECK(std::abs(at_x + at_y - inner) <=
            conjugacy * (1 + std::abs(at_x) + std::abs(at_y) + W.norm(p.x) * W.norm(q.x)));
    }
  }
}

TEST_CASE("the conjugate of f(Ax) with a wide A is f* on the range of its transpose, +inf off it") {
  // f = ||.||_1, A = [[1,1,0],[0,1,-1]]: f*(v) = 0 where v = Aᵀw with |w_i| <= 1.
  const Function g = samples::function("precompose(norm1(), [[1,1,0],[0,1,-1]])", 3).conjugate();
  const auto at = [&](double a, double b, double c) { return g(Eigen::Vector3d(a, b, c)); };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK(at(0.5, 0.25, 0.25) == 0);        // w = (1/2, -1/4)
  CHECK(at(1, 2, -1) == 0);               // w = (1, 1), at the corner
  CHECK(at(1, 2.25, -1.25) == infinity);  // w = (1, 5/4)
  CHECK(at(0.5, 0.25, 0.5) == infinity);  // no w: off the range
  // f = ½||.||², b = (1, 2): f*(Aᵀw) = ½|w|² - b·w.
  const Function h =
      samples::function("precompose(squared_norm2(), [[1,1,0],[0,1,-1]], [1,2])", 3).conjugate();
  CHECK(h(Eigen::Vector3d(0.5, 0.25, 0.25)) == doctest::Approx(0.15625).epsilon(1e-14));
  CHECK(h(Eigen::Vector3d(0.5, 0.25, 0.5)) == infinity);
}

TEST_CASE("a support function is homogeneous down to points that are all rounding") {
  const Function f = samples::function("support(intersection(ball2(1), box(0, 2)))", 3);
  const Vector x = Eigen::Vector3d(6.2612733940231137, 0.95612806206086231, 0.36890104275753094);
  for (double size : {1e-300, 1e-21, 1e-10, 1.0, 1e8})
    CHECK(f(size * x) == doctest::Approx(size * x.norm()).epsilon(1e-13));
}

TEST_CASE("a conjugate that is approached at a corner of its domain has its value there") {
  const Function f =
      samples::function("precompose(logistic(), [[1,2,0],[0,1,1],[1,0,1],[2,1,1]], [1,0,-1,0])", 3);
  CHECK(f.conjugate()(Vector::Zero(3)) == doctest::Approx(0).epsilon(1e-9));  // -inf f = 0
}

TEST_CASE("the conjugate of f(Ax) with an ill-conditioned A has f(Ax) for its own conjugate") {
  const Function f = samples::function("precompose(norm2(), [[1,1,0],[1,1.0000001,0],[0,0,1]], [1,2,3])", 3);
  CHECK(to_text(f.conjugate().conjugate().call()) == to_text(f.call()));
}
