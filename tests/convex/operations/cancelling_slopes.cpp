#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Proxes of one entry whose slope is what is left of large terms, is taken at a rounded argument, or is any.
using convex::Metric;
using convex::Prox;
using convex::Status;
using convex::Value;
using convex::Vector;
using samples::function;

TEST_CASE("the bound of a prox of one entry holds where slopes cancel") {
  struct Case {
    const char* f;
    double z, w, x;  // w (x - z) + f'(x) = 0, by forty digits
  };
  for (const auto& [f, z, w, x] :
       {Case{"tilt(logistic(),-1)", 50, 1e-22, 50.83599941},
        {"tilt(logistic(),-1)", 1, 1e-12, 24.47508161417463315},
        {"tilt(logistic(),-1)", 0, 1e-10, 20.0286854113973268},
        {"sum(norm1(0.5),logistic())", -5.958e-06, 1, -4.7664000000018050709e-6}}) {
    CAPTURE(std::string(f));
    CAPTURE(z);
    const Prox found = function(f, 1).prox(Vector::Constant(1, z), Metric::diagonal(Vector::Constant(1, w)));
    CHECK(std::sqrt(w) * std::abs(found.x[0] - x) <= found.error_bound);
  }
}

TEST_CASE("the error of an envelope's value holds where the function is steep at its prox") {
  // The prox is 2e-20, where the slope is 5e11 times that of the square: e(-2) in forty digits.
  const Value found = function(
                          "envelope(sum(tilt(dilate(dilate(power(1.0001),1e-12),2.0),-3.14e-06),negative_"
                          "power(1e-08)),0.0203)",
                          1)
                          .evaluate(Vector{{-2}});
  CHECK(std::abs(found.value - 97.522167951) <= found.error + 1e-8);
}

TEST_CASE("the prox of a function whose domain is one point is that point, with every slope") {
  // Both parts of the maximum are -0.885… there.
  const auto f = function(
      "pointwise_max(inf_convolution(tilt(power(1.25), [1.6096934855633716]), pointwise_max(squared_hinge(), "
      "sum(log_sum_exp(), constant(-3)))), sum(translate(indicator(hyperplane([-2], 1050)), [523.25]), "
      "constant(-0.8853314170598544)))",
      1);
  const auto split = convex::decompose(f, Vector{{-1.75}}, Metric::identity(1));
  CHECK(split.status == Status::solved);
  CHECK(split.x.x[0] == -1.75);
}
