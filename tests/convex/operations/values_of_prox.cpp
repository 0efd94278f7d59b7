#include <doctest/doctest.h>

#include <cmath>

#include "tests/convex/operations/samples.hpp"

using convex::Function;
using convex::Index;
using convex::Metric;
using convex::Prox;
using convex::Vector;

namespace {

/// Functions of two entries whose value and whose conjugate's value are by formula, or by programs that
/// settle.
constexpr const char* expressions_with_values[] = {
    "logistic()",
    "translate(exponential(), [1,-2])",
    "tilt(logistic(), [0.5,0.25])",
    "scale(dilate(entropy(), -2), 3)",
    "separable(exponential(), 1, log_barrier(), 1)",
    "sum(exponential(), quadratic([[2,1],[1,2]], [1,-1]))",
    "precompose(exponential(), [[2,1],[1,-1]], [1,0.5])",
    "envelope(exponential(), 0.5)",
    "inf_convolution(logistic(), quadratic([[2,1],[1,2]], [0.5,0.25]))",
    "distance(ball2(1, [2,0]), 3)",
    "proximal_average(logistic(), exponential(), 0.25, 1)",
    "perspective(exponential())",
    "pointwise_max(exponential(), squared_norm2(3))",
    "sum(logistic(), norm2(0.25))",
};

}  // namespace

TEST_CASE("the values that come with a prox are those of the function at x and of its conjugate at v") {
  Index seen = 0;
  for (const char* text : expressions_with_values) {
    CAPTURE(text);
    const Function f = samples::function(text, 2);
    for (const Metric& W : samples::metrics(2))
      for (const Vector& z : samples::points(2)) {
        CAPTURE(z.transpose());
        const Prox found = f.prox(z, W);
        if (!found.values || found.error_bound > 1e-9) continue;
        ++seen;
        const convex::Value f_x = f.evaluate(found.x), f_v = f.conjugate().evaluate(found.v);
        const double size = 1 + std::abs(f_x.value) + found.v.norm() * found.x.norm();
        const auto& [of_x, of_v, miss] = *found.values;
        if (std::isfinite(f_x.value)) CHECK(std::abs(of_x.value - f_x.value) <= 1e-9 * size + f_x.error);
        if (std::isfinite(f_v.value)) CHECK(std::abs(of_v.value - f_v.value) <= 1e-9 * size + f_v.error);
        CHECK(miss <= 1e-9);
        CHECK(std::abs(of_x.value + of_v.value - found.x.dot(found.v)) <= 1e-9 * size);
      }
  }
  CHECK(seen > 250);
}
