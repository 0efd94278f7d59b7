#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "convex/proved_prox/proved_split.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Decomposition;
using convex::Function;
using convex::Matrix;
using convex::Metric;
using convex::Vector;

namespace {

/// [[1 + e, 1], [1, 1 + 2e]], e = 2^-k: its columns are one but for e, and its entries are doubles.
Metric nearly_dependent(int k) {
  const double e = std::exp2(-k);
  return Metric::dense(Matrix{{1 + e, 1}, {1, 1 + 2 * e}});
}

Decomposition split_of(const char* text, const Vector& z, const Metric& W) {
  return convex::decompose(samples::function(text, W), z, W);
}

/// The W-norm of x - truth, with W and both at their exact values.
double distance(const Vector& x, const Vector& truth, const Metric& W) {
  const convex::ProvedMetric exact(convex::exact_gram(W));
  return exact.norm_above(convex::difference(convex::fractions(x), convex::fractions(truth)));
}

constexpr int exponents[] = {4, 10, 20, 30, 40, 50};

}  // namespace

TEST_CASE(
    "an envelope whose function holds 0 takes z/(1 + gamma) off z, however nearly dependent the metric is") {
  // prox of (1 + gamma) f at z is 0 where the slope Wz is one of (1 + gamma) f at 0; then x = gamma
  // z/(1+gamma).
  const Vector z{{0.5, 3.5}}, x{{0.375, 2.625}}, y{{0.125, 0.875}};
  for (const int k : exponents)
    for (const char* text :
         {"envelope(norm1(10),3)", "envelope(point(0),3)", "translate(envelope(norm1(10),3),[0,0])"}) {
      CAPTURE(k);
      CAPTURE(text);
      const Metric W = nearly_dependent(k);
      const Decomposition split = split_of(text, z, W);
      CHECK(split.status == convex::Status::solved);
      CHECK(distance(split.x.x, x, W) <= split.error_bound);
      CHECK(distance(split.y.x, y, W) <= split.error_bound);
    }
}

TEST_CASE("where Wz/4 is a subgradient at 0, the prox of the conjugate of an envelope with step 3 is z/4") {
  // g(y) = f*(Wy) + 3/2 ||y||_W² is 3/2 ||y||_W² where |Wy| <= 1 in each entry.
  const Vector z{{0.125, 3}}, quarter{{0.03125, 0.75}};
  for (const int k : exponents) {
    CAPTURE(k);
    const Metric W = nearly_dependent(k);
    const Decomposition split = split_of("conjugate(envelope(norm1(1),3))", z, W);
    CHECK(split.status == convex::Status::solved);
    CHECK(distance(split.x.x, quarter, W) <= split.error_bound);
    CHECK(distance(split.y.x, 3 * quarter, W) <= split.error_bound);
  }
}

TEST_CASE(
    "the conjugate of an envelope with step gamma adds gamma/2 ||y||_W² for the W given, not for one "
    "rounded") {
  const Vector y{{0.125, 0.25}};
  for (const int k : exponents)
    for (const char* part : {"norm1(1)", "norm2(1)"}) {
      CAPTURE(k);
      CAPTURE(part);
      const Metric W = nearly_dependent(k);
      const Function f = samples::function("envelope(" + std::string(part) + ",3)", W);
      const convex::Value value = f.conjugate(W).evaluate(y);
      // |Wy| < 1, and 3/2 y·Wy = 3/2 ((3/8)² + e (1/64 + 2/16)) needs at most 52 + 6 bits.
      const long double truth = 1.5L * (9.0L / 64 + 9.0L / 64 * std::exp2(-static_cast<long double>(k)));
      CHECK(std::abs(static_cast<double>(value.value - truth)) <= value.error);
      CHECK(value.error <= 1e-14 * value.value);
    }
}

TEST_CASE("a proximal average in a nearly dependent metric has the prox of the numbers given") {
  // Solved with 60 digits by another program.
  const Metric W = nearly_dependent(26);
  const Decomposition split = split_of("proximal_average(norm1(1),zero(),0.125,4)", Vector{{0.5, 3.5}}, W);
  const Vector x{{0.482758620689655172, 3.392241382521801886}};
  CHECK(split.status == convex::Status::solved);
  // The doubles nearest to the truth are off by their own rounding.
  CHECK(distance(split.x.x, x, W) <= split.error_bound + 1e-15);
}

TEST_CASE("the value of a conjugate of an average with a far step is right to its error") {
  const Metric W = nearly_dependent(6);
  const Function f =
      samples::function("proximal_average(ball2(0.12171965027135051),norm1(0.228),0.3,1000001)", W);
  const convex::Value value = f.conjugate(W).evaluate(Vector{{2, -3.615}});
  // Known with 20 digits from another program.
  CHECK(std::abs(value.value - 2545351.29489388384807622) <= value.error);
}

TEST_CASE("the prox of |.|_1 with its slopes in a box keeps its digits in a nearly dependent metric") {
  // y = (0, w) with Wy = (w, (1 + 2e) w) at the edge |.| <= 1 of the box: w = 1/(1 + 2e), and x = z - y.
  const Metric W = nearly_dependent(30);
  const Vector z{{0.1, 3}}, y{{0, 1 / (1 + std::exp2(-29))}}, x{{0.1, 3 - 1 / (1 + std::exp2(-29))}};
  const Decomposition split = split_of("inf_convolution(conjugate(norm1(1)),norm1(1))", z, W);
  CHECK(split.status == convex::Status::solved);
  CHECK(distance(split.x.x, x, W) <= split.error_bound + 1e-15);
  CHECK(distance(split.y.x, y, W) <= split.error_bound + 1e-15);
}

TEST_CASE("no bound of a decomposition is told that is less than what its points miss of z") {
  for (const int k : {10, 16, 20, 24})
    for (const char* text : {"nuclear_norm(3.641,rows=2)", "norm2(3)", "envelope(norm2(3),3)"}) {
      CAPTURE(k);
      CAPTURE(text);
      const Decomposition split = split_of(text, Vector{{100, -1}}, nearly_dependent(k));
      CHECK(split.error_bound >= split.residual);
    }
}

TEST_CASE("a function of the plain product keeps its meaning where fractions split it in another") {
  // The support function of a box in the plain product is 2|u_1| + 2|u_2|, in that of W another.
  const Metric W = nearly_dependent(20);
  const Vector z{{0.5, 3.5}};
  const Function support = samples::function("support(box(-2,2))", 2),
                 norm = samples::function("norm1(2)", 2);
  const Decomposition one = convex::decompose(support, z, W), other = convex::decompose(norm, z, W);
  CHECK(distance(one.x.x, other.x.x, W) <= one.error_bound + other.error_bound);
  for (const Vector& y : {Vector{{0.25, 0.5}}, Vector{{0.5, 1.25}}})
    CHECK(support.conjugate(W)(y) == norm.conjugate(W)(y));
}
