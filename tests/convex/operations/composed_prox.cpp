#include "convex/operations/composed_prox.hpp"

#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "convex/gamma0/node.hpp"
#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Function;
using convex::Metric;
using convex::Prox;
using convex::Vector;

namespace {

constexpr const char* one_after_another = "one prox after another";

bool is_composed(const Prox& found) { return found.method.find(one_after_another) != std::string::npos; }

/// Both within their bounds of the same point.
void check_against_program(const Function& f, const Vector& z, const Metric& W, const Prox& found) {
  CAPTURE(z.transpose());
  const auto expected = convex::prox_by_program(f, z, W);
  REQUIRE(expected);
  CHECK(W.norm(found.x - expected->x) <= 2 * (found.error_bound + expected->error_bound) + 1e-14 * W.norm(z));
}

}  // namespace

TEST_CASE("the fused lasso is the soft threshold of what total variation leaves") {
  // Total variation takes 1 from the first entry and gives it to the second, the norm then 0.5 from both.
  const Prox found = samples::function("sum(norm1(0.5), total_variation(1))", 2)
                         .prox(Eigen::Vector2d(3, 1), Metric::identity(2));
  CHECK(found.x == Vector(Eigen::Vector2d(1.5, 1.5)));
  CHECK(is_composed(found));
}

TEST_CASE("the nearest point of a cone in a ball is the cone's, shortened") {
  const Prox found = samples::function("sum(indicator(ball2(1)), indicator(orthant()))", 3)
                         .prox(Eigen::Vector3d(3, -2, 4), Metric::identity(3));
  CHECK((found.x - Eigen::Vector3d(0.6, 0, 0.8)).norm() <= 1e-15);
  CHECK(is_composed(found));
}

TEST_CASE("one prox after another is the prox of the sum, where a theorem says so") {
  for (const char* text :
       {"sum(norm1(0.7), norm2())", "sum(norm2(2), indicator(orthant()), norm1())",
        "sum(indicator(ball2(2)), indicator(second_order_cone()))", "sum(norm2(), total_variation(0.5))",
        "sum(total_variation(0.3), huber(0.5), indicator(box(-1, 2)))", "sum(max(), hinge())",
        "sum(sum_largest(2), indicator(box(-0.5, 1)))", "sum(total_variation(2), entropy())",
        "sum(dilate(max(), -1), norm1(0.2))"}) {
    CAPTURE(std::string(text));
    const Function f = samples::function(text, 4);
    for (const double size : {1.0, 0.3})
      for (const Vector& z : samples::points(4)) {
        const Metric W = Metric::diagonal(Vector::Constant(4, size));
        const Prox found = f.prox(z, W);
        CHECK(is_composed(found));
        check_against_program(f, z, W, found);
      }
  }
}

TEST_CASE("one prox after another is not taken for the prox of other sums, or in other metrics") {
  for (const char* text :
       {"sum(norm2(), indicator(box(-1, 2)))", "sum(norm2(), hinge())", "sum(norm_inf(), norm1())",
        "sum(total_variation(), norm1([1,2,3,4]))", "sum(max(), translate(hinge(), [1,0,0,0]))",
        "sum(translate(norm2(), [1,0,0,0]), norm1())", "sum(indicator(ball2(1, [1,0,0,0])), norm1())",
        "sum(translate(max(), [0,0,3,0]), norm1())"}) {
    CAPTURE(std::string(text));
    const Function f = samples::function(text, 4);
    for (const Vector& z : samples::points(4)) {
      const Prox found = f.prox(z, Metric::identity(4));
      CHECK_FALSE(is_composed(found));
      check_against_program(f, z, Metric::identity(4), found);
    }
  }
  const Function f = samples::function("sum(norm1(), norm2())", 4);
  for (const Metric& W : samples::metrics(4)) {
    if (W.kind() == convex::MetricKind::identity) continue;
    CHECK_FALSE(is_composed(f.prox(samples::points(4)[3], W)));
  }
}

TEST_CASE("a sum of functions of one entry each is solved entry by entry in a diagonal metric") {
  for (const char* text : {"sum(norm1(), indicator(box([-1,0,-inf,2], [1,3,0,2])))",
                           "sum(norm1([1,0,2,3]), hinge(), linear([1,-1,0.5,2]))", "sum(entropy(), hinge())",
                           "sum(translate(norm1(), [1,2,0,-1]), scale(huber(0.2), 3), hinge())",
                           "sum(separable(norm1(), 1, indicator(orthant()), 2, norm2(), 1), pinball(0.3))",
                           "inf_convolution(norm1(2), translate(huber(0.5), [1,0,-1,3]))",
                           "sum(constant(3), norm1(), hinge())"}) {
    CAPTURE(std::string(text));
    const Function f = samples::function(text, 4);
    const std::vector<Metric> metrics = samples::metrics(4);
    for (const Metric& W : {metrics[0], metrics[1]})
      for (const Vector& z : samples::points(4)) {
        const Prox found = f.prox(z, W);
        CHECK(found.method.find("by entries") != std::string::npos);
        check_against_program(f, z, W, found);
      }
  }
}

TEST_CASE("the entries of a separable function add up to it but for a constant") {
  for (const char* text :
       {"norm1([1,2,3])", "indicator(box([0,-1,-2], [3,3,3]))", "translate(huber(0.5), [1,0,-1])",
        "tilt(logistic(), [1,2,3])", "dilate(translate(norm1(), [1,2,3]), -2)",
        "separable(norm2(), 1, norm1([1,4]), 2)", "sum(norm1([1,2,3]), linear([3,2,1]))"}) {
    CAPTURE(std::string(text));
    const Function f = samples::function(text, 3);
    const Vector x = Eigen::Vector3d(0.25, 2, -1.5), y = Eigen::Vector3d(1, 0.5, -0.5);
    double of_entries = 0;
    for (convex::Index i = 0; i < 3; ++i) {
      const auto entry = f.node().entry(i);
      REQUIRE(entry);
      of_entries += (*entry)(x.segment(i, 1)) - (*entry)(y.segment(i, 1));
    }
    CHECK(of_entries == doctest::Approx(f(x) - f(y)).epsilon(1e-14));
  }
  CHECK_FALSE(samples::function("norm2()", 3).node().entry(0));
  CHECK_FALSE(samples::function("sum(norm1(), norm2())", 3).node().entry(0));
}

TEST_CASE(
    "functions of one entry that are steep at 0 are split to the last digits from a point far outside") {
  struct Steep {
    const char* f;
    Vector z;
  };
  for (const Steep& question :
       {Steep{"sum(negative_power(0.5), inverse_power(1))", Vector{{-1e8}}},
        {"sum(tilt(negative_power(0.5), [-2,2]), scale(inverse_power(0.5), 0.25))", Vector{{-3e8, 2e8}}},
        {"sum(sum(negative_power(0.5), max()), inverse_power(1))", Vector{{-1e8, 3e8, -3e8, -3e8}}}}) {
    CAPTURE(std::string(question.f));
    const Vector& z = question.z;
    const Metric W = Metric::identity(z.size());
    const convex::Decomposition split = convex::decompose(samples::function(question.f, z.size()), z, W);
    CHECK(split.status == Status::solved);
    CHECK(std::abs(split.fenchel_gap) <= 1e-9 * (std::abs(split.f_x) + std::abs(split.g_y)));
  }
  // 0 = x + 1e8 - 1/(2 sqrt(x)) - 1/x²: x = 1e-4 up to some 1e-11 of it
  const Vector x = samples::function("sum(negative_power(0.5), inverse_power(1))", 1)
                       .prox(Vector{{-1e8}}, Metric::identity(1))
                       .x;
  CHECK(std::abs(x[0] - 1e-4 - 0.5 * 1e-4 * 50e-8) <= 1e-12);
}
