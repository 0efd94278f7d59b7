#include <doctest/doctest.h>

#include <cmath>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/symbolic/function_of_call.hpp"

using namespace convex;

namespace {

/// What has rules, alone and under operations.
const char* const symbolic_calls[] = {"norm1(weight=2)",
                                      "huber(0.5)",
                                      "hinge()",
                                      "elastic_net(1, 2)",
                                      "indicator(box(-1, 2))",
                                      "support(box(-1, 2))",
                                      "plq([0, 1], [[2, 0, 0], [0, 0, 0], [inf, 0, 0]])",
                                      "quadratic([[3]], [-1])",
                                      "power(1)",
                                      "power(2)",
                                      "norm1()",
                                      "huber()",
                                      "pinball(0.9)",
                                      "quadratic([[3]], [1], 2)",
                                      "elastic_net()",
                                      "power()",
                                      "inverse_power()",
                                      "envelope(huber(), 2)",
                                      "ball2()",
                                      "conjugate(envelope(norm1(), 1/2))",
                                      "precompose(conjugate(huber()), [[2]], [1])",
                                      "exponential()",
                                      "entropy()",
                                      "log_barrier()",
                                      "logistic()",
                                      "power(3)",
                                      "power(1.5)",
                                      "power(4)",
                                      "power(2.5)",
                                      "inverse_power(1)",
                                      "inverse_power(2.5)",
                                      "kullback_leibler(2)",
                                      "conjugate(entropy())",
                                      "conjugate(logistic())",
                                      "conjugate(power(3))",
                                      "conjugate(inverse_power(2))",
                                      "envelope(exponential(), 0.5)",
                                      "envelope(entropy(), 2)",
                                      "envelope(norm1(), 2)",
                                      "envelope(conjugate(logistic()), 1/2)",
                                      "translate(entropy(), 2)",
                                      "tilt(logistic(), 0.3)",
                                      "scale(log_barrier(), 3)",
                                      "dilate(exponential(), -2)",
                                      "dilate(entropy(), 2)",
                                      "sum(exponential(), squared_norm2(2))",
                                      "sum(entropy(), quadratic([[1]], [-1]))",
                                      "inf_convolution(norm1(), squared_norm2(3))",
                                      "inf_convolution(exponential(), squared_norm2(1/2))",
                                      "sum(norm1(), indicator(box(-1, 3)), squared_norm2())",
                                      "precompose(huber(1), [[2]], [1])",
                                      "max()",
                                      "sum_largest(1)",
                                      "max_affine([[-1],[1/2],[2]], [0,1,-3])",
                                      "squared_hinge()",
                                      "sorted_norm1([2])",
                                      "log_sum_exp()",
                                      "distance(box(-1, 1/2), 2)",
                                      "squared_distance(box(-1, 1/2), 3)",
                                      "intersection(halfspace([2], 3), halfspace([-1], 2))",
                                      "pointwise_max(norm1(), constant(1))",
                                      "pointwise_max(squared_norm2(2), linear([2]), constant(1/4))",
                                      "pointwise_max(sum(norm1(), indicator(box(-2, 3))), huber(0.5))",
                                      "pointwise_max(squared_norm2(2), tilt(squared_norm2(2), [1]))",
                                      "proximal_average(norm1(), squared_norm2(2), 1/3, 2)",
                                      "proximal_average(indicator(box(-1, 2)), hinge(), 0.5)",
                                      "sum(exponential(), entropy())",
                                      "sum(exponential(), power(4))",
                                      "sum(entropy(), translate(log_barrier(), 1/2))",
                                      "sum(logistic(), power(3), inverse_power(1))",
                                      "translate(scale(dilate(kullback_leibler(1/3), 2), 1/2), -1)",
                                      "sum(exponential(), norm1())",
                                      "sum(norm1(2), translate(exponential(), 1), hinge())",
                                      "sum(log_barrier(), indicator(box(1/3, 2)))",
                                      "sum(log_barrier(), indicator(box(-1, 2)))",
                                      "sum(entropy(), norm1())",
                                      "sum(entropy(), huber(1/2), indicator(box(0, 4)))",
                                      "sum(indicator(box(-1, 3)), exponential(), elastic_net(1, 2))",
                                      "sum(logistic(), norm1(1/3))",
                                      "sum(power(3), norm1(), indicator(box(-2, inf)))",
                                      "sum(kullback_leibler(2), translate(norm1(), [1]))",
                                      "sum(exponential(), power(4), norm1())",
                                      "sum(conjugate(logistic()), hinge())",
                                      "sum(conjugate(exponential()), translate(norm1(), [2]))",
                                      "sum(exponential(), indicator(point([1/2])))",
                                      "scale(dilate(sum(exponential(), norm1()), -2), 3)",
                                      "translate(tilt(sum(log_barrier(), hinge()), [1]), [-2])",
                                      "conjugate(sum(entropy(), norm1()))",
                                      "inf_convolution(exponential(), indicator(box(-1, 1/2)))",
                                      "inf_convolution(norm1(1/2), exponential())"};

}  // namespace

TEST_CASE("formulas by cases have the values of the function, its conjugate and its prox in numbers") {
  for (const char* text : symbolic_calls)
    for (const int weight : {1, 2}) {
      const Call call = cli::parse_call(text, "f");
      const Metric W = Metric::identity(1).scaled(weight);
      const Fraction w{weight, 1};
      const Function number = make_function(call, {W}), dual = number.conjugate(W);
      const symbolic::Function f = symbolic::function_of(call, w);
      const symbolic::Cases formula = symbolic::formula(f);
      symbolic::Cases conjugate;
      try {
        conjugate = symbolic::conjugate_formula(dilate(f, w));
      } catch (const InvalidInput&) {  // of a sum by rules that is not known to grow
        CHECK(std::string(text).rfind("sum(", 0) == 0);
      }
      CAPTURE(text);
      CAPTURE(weight);
      for (const double at : {-3.7, -1.3, -0.61, -0.2, 0.17, 0.43, 0.9, 1.6, 2.4, 5.1}) {
        CAPTURE(at);
        const Vector point = Vector::Constant(1, at);
        const double f_value = number(point), f_formula = evaluate(formula, "x", at);
        CHECK(std::isfinite(f_value) == std::isfinite(f_formula));
        if (std::isfinite(f_value)) CHECK(f_formula == doctest::Approx(f_value).epsilon(1e-9));
        if (!conjugate.empty()) {
          const double g_value = dual(point), g_formula = evaluate(conjugate, "y", at);
          CHECK(std::isfinite(g_value) == std::isfinite(g_formula));
          if (std::isfinite(g_value)) CHECK(g_formula == doctest::Approx(g_value).epsilon(1e-9));
        }
        for (const double gamma : {1.0, 0.25, 4.0}) {
          const double x = number.prox(point, W.scaled(1 / gamma)).x[0];
          const symbolic::Cases prox = symbolic::prox_formula(f, symbolic::simplest_fraction(gamma) / w);
          CAPTURE(gamma);
          CHECK(std::abs(evaluate(prox, "z", at) - x) <= 1e-9 * std::max(1.0, std::abs(x)));
        }
      }
    }
}

TEST_CASE("what has no rule is refused by name") {
  for (const char* text :
       {"nuclear_norm(1, 1)", "sum(envelope(exponential(), 1), norm1())", "pointwise_max(entropy(), norm1())",
        "sum_largest(2)", "sum(exponential(), dilate(log_barrier(), -1))"})
    CHECK_THROWS_AS(symbolic::function_of(cli::parse_call(text, "f")), InvalidInput);
}
