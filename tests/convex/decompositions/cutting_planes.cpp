#include "convex/decompositions/cutting_planes.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "convex/gamma0/node.hpp"
#include "tests/convex/operations/samples.hpp"

/// The prox seen through values and subgradients alone, beside that by formula.
using namespace convex;

namespace {

struct Known {
  const char* f;
  std::vector<double> z;
};

/// Finite everywhere or not, with kinks or without, near and far.
const Known functions[] = {
    {"norm1(2)", {3, -0.5, 1e8}},
    {"norm2(1)", {3, -4}},
    {"huber(0.5)", {3e8, 0.1, -2}},
    {"max_affine([[1,2],[-3,1],[0,-1]], [0,1,-2])", {4, 5}},
    {"indicator(box(-1, 2))", {7, -3e8, 0.5}},
    {"indicator(ball2(1))", {3, 4}},
    {"squared_norm2(8)", {1e8, 2}},
    {"log_barrier()", {-2, 3}},
};

/// A line above the function: the slopes of |x| with an error.
class WrongSlopes final : public FunctionNode {
 public:
  Index dimension() const override { return 1; }
  Facts facts() const override { return {.finite = true}; }
  Call call() const override { return {"wrong_slopes"}; }
  double value(const Vector& x) const override { return std::abs(x[0]); }
  Prox prox(const Vector&, const Metric&, const Look&) const override { return {}; }
  Function conjugate() const override { return Function(std::make_shared<WrongSlopes>()); }
  std::optional<Vector> subgradient(const Vector& x) const override {
    return Vector::Constant(1, x[0] > 0 ? 1.5 : -1);
  }
};

}  // namespace

TEST_CASE("cutting planes come to the prox that a formula gives, and their bound holds") {
  for (const Known& known : functions) {
    CAPTURE(std::string(known.f));
    const auto n = static_cast<Index>(known.z.size());
    const Vector z = Eigen::Map<const Vector>(known.z.data(), n);
    for (const Metric& W : {Metric::identity(n), Metric::diagonal(Vector::LinSpaced(n, 0.5, 3))}) {
      const Function f = samples::function(known.f, n);
      const double enough = 1e-6 * W.norm(z);
      const auto found = prox_by_cuts(f, Vector::Constant(n, 0.25), z, W, enough, Look{});
      REQUIRE(found);
      const Prox exact = f.prox(z, W);
      CHECK(found->error_bound <= enough);
      CHECK(W.norm(found->x - exact.x) <= found->error_bound + exact.error_bound);
      // f(x) and f*(v) are those at x and v, as far as their errors say.
      REQUIRE(found->values);
      const Value at_v = f.conjugate().evaluate(found->v);
      if (std::isfinite(at_v.value))
        CHECK(at_v.value <= found->values->f_v.value + found->values->f_v.error + at_v.error);
    }
  }
}

TEST_CASE("a subgradient that is none widens the bound of cutting planes, or nothing is told") {
  const Function f(std::make_shared<WrongSlopes>());
  for (const double z : {1.25, 0.5, 3.0}) {
    CAPTURE(z);
    const double exact = std::max(0.0, z - 1);
    const auto found =
        prox_by_cuts(f, Vector::Constant(1, 2), Vector::Constant(1, z), Metric::identity(1), 10, Look{});
    if (found) CHECK(std::abs(found->x[0] - exact) <= found->error_bound);
  }
}

TEST_CASE("splits that programs leave open are seen through the values of f or of its conjugate alone") {
  struct Open {
    const char* f;
    std::vector<double> z;
  };
  const Open open[] = {
      {"conjugate(pointwise_max(sum(inverse_power(0.5), norm1(3)), pointwise_max(max_affine([[-2,0,2,0],"
       "[-1,-1,-1,-2]], [2,0]), entropy())))",
       {-3e8, -3e8, 2, -3e8}},
  };
  for (const Open& question : open) {
    CAPTURE(std::string(question.f));
    const auto n = static_cast<Index>(question.z.size());
    const Vector z = Eigen::Map<const Vector>(question.z.data(), n);
    const Decomposition split = decompose(samples::function(question.f, n), z, Metric::identity(n));
    CHECK(split.status == Status::solved);
    CHECK(split.error_bound <= 1e-9 * z.norm());
  }
}

TEST_CASE("where rounding of a far z leaves x outside the domain a point of the domain is told") {
  Matrix gram(3, 3);
  gram << 9, -3, -9, -3, 2, 3, -9, 3, 10;
  const Metric W = Metric::dense(gram);
  const Function f = samples::function("sum(indicator(orthant()), binary_entropy())", W);
  const Decomposition split = decompose(f, Vector{{-3, -1, -3e8}}, W);
  CHECK(split.status == Status::solved);
  CHECK(split.x.x.minCoeff() >= 0);
  CHECK(split.x.x.maxCoeff() <= 1);
}

TEST_CASE("a value that no program decides is not that of a maximum without it") {
  // At x = 1e-160 the sums of a program underflow; max(x, 2x - 3) is x there, and f*(1) is -1/2.
  const Function line = samples::function("max_affine([[2],[1]], [-3,0])", 1);
  const Vector tiny = Vector::Constant(1, 1e-160);
  CHECK(line.evaluate(tiny).value == 1e-160);
  CHECK(line.evaluate(tiny).error <= 1e-175);
  CHECK(line.subgradient(tiny)->isApprox(Vector::Ones(1)));
  const Function larger = samples::function(
      "pointwise_max(quadratic([[2]],[3]), sum(plq([-1,1],[[0,-1,0],[1,0,0.5],[0,1,0]]), "
      "max_affine([[2],[3],[1]],[-3,-3,0])))",
      1);
  const Value found = larger.conjugate().evaluate(Vector::Ones(1));
  CHECK(std::abs(found.value + 0.5) <= found.error);
  CHECK(found.error <= 1e-12);
}

TEST_CASE("an inf-convolution with a line is a line only where the conjugate's value there is known") {
  // sup of -1/sqrt(x) is 0 and not attained: the line through it is not known to a doubt of 2e-5.
  const Function f =
      samples::function("inf_convolution(linear([1]), sum(sum_largest(1), inverse_power(0.5)))", 1);
  const Value found = f.conjugate().evaluate(Vector::Ones(1));
  CHECK(std::abs(found.value) <= found.error);
}

TEST_CASE("values of proximal averages and inf-convolutions of one entry come from values of the parts") {
  // The least over q, searched here on a grid in long doubles.
  const Function average = samples::function(
      "proximal_average(power(3), scale(pointwise_max(linear([1]), quadratic([[2]],[-3])), 3), 0.5, 3)", 1);
  const auto f = [](long double p) { return std::abs(p * p * p); };
  const auto g = [](long double q) { return 3 * std::max(q, q * q - 3 * q); };
  for (const double x : {0.0, 1e-31, 1e-3, -0.75, 2.0}) {
    CAPTURE(x);
    long double least = INFINITY;
    for (int k = -4'000'000; k <= 4'000'000; ++k) {
      const long double q = 1e-6L * k, p = 2 * static_cast<long double>(x) - q;
      least = std::min(least, (f(p) + g(q)) / 2 + (p - q) * (p - q) / 24);
    }
    const Value found = average.evaluate(Vector::Constant(1, x));
    CHECK(found.error <= 1e-12);
    CHECK(found.value <= static_cast<double>(least) + found.error);
    CHECK(found.value >= static_cast<double>(least) - 1e-10);
  }
}

TEST_CASE(
    "the conjugate of a support function is told as 0 however far z is, where x is rounding beside it") {
  const Metric W = Metric::diagonal(Vector{{2, 1, 0.03125}});
  const Function f = samples::function(
      "perspective(separable(inf_convolution(plq([-1,1],[[0,-1,0],[1,0,0.5],[0,1,0]]), log_barrier()), 1, "
      "elastic_net(1, 0.5), 1))",
      W);
  const Decomposition split = decompose(f, Vector{{2e8, -2, 3e8}}, W);
  CHECK(split.status == Status::solved);
  CHECK(split.g_y == 0);
}

TEST_CASE("a function that is finite everywhere is told as +inf at no tiny number") {
  const Function average = samples::function("proximal_average(norm2(1024), norm1(0.5), 0.5, 1)", 1);
  for (const double x : {1e-21, -1e-40, -7.25e-60, 1e-100}) {
    CAPTURE(x);
    const Value found = average.evaluate(Vector::Constant(1, x));
    CHECK(std::abs(found.value - std::abs(x) / 2) <= found.error + std::abs(x) * std::abs(x));
    CHECK(found.error <= 1e-12);
  }
  const Function larger = samples::function(
      "pointwise_max(proximal_average(exponential(), log_barrier(), 0.5, 1), proximal_average(norm2(1024), "
      "norm1(0.5), 0.5, 1))",
      1);
  const Value found = larger.conjugate().evaluate(Vector::Constant(1, -1e-12));
  CHECK(std::abs(found.value + 0.5585132767005535) <= found.error + 1e-14);
}
