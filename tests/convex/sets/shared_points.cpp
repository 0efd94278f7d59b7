#include <doctest/doctest.h>

#include <cmath>

#include "cli/function_language/parse_call.hpp"
#include "convex/proved_prox/pair_search.hpp"
#include "convex/proved_prox/proved_split.hpp"
#include "convex/sets/subdifferential.hpp"

/// How the two parts of an inf-convolution share a point: u with the slope of the one, x - u with that of the
/// other.
using namespace convex;

namespace {

Subdifferential at(const char* f, const char* x) {
  return subdifferential(cli::parse_call(f, "f"), identity_gram(1), {read_fraction(x).value()});
}

}  // namespace

TEST_CASE("the slope of an inf-convolution is right to rounding however steep or far apart its parts are") {
  struct Case {
    const char *f, *x;
    double slope;
  };
  for (const auto& [f, x, slope] :
       {// u² - u = 1: -1/u is minus the golden ratio's inverse.
        Case{"inf_convolution(translate(squared_norm2(1),[0]),log_barrier())", "1", -0.6180339887498948482},
        // e^w = c (x - w): c W(e^x / c), W Lambert's function.
        {"inf_convolution(translate(squared_norm2(1e-06),[0]),exponential())", "5", 1.6040400017114048727e-5},
        {"inf_convolution(exponential(),translate(squared_norm2(1),[1000000]))", "1000003",
         2.2079400315693229986},
        // log u + 1 = c (1/2 - u), and 4 u³ = c (1/2 - u), by Newton's method in sixty digits.
        {"inf_convolution(entropy(),translate(squared_norm2(0.001),[1000000]))", "1000000.5",
         0.00013207196905778356991},
        {"inf_convolution(power(4),translate(squared_norm2(1e-06),[0]))", "0.5", 4.9501666660473249e-7}}) {
    CAPTURE(f);
    const Subdifferential found = at(f, x);
    REQUIRE(found.is_single());
    CHECK_FALSE(found.is_exact);
    const double told = nearest(found.polyhedron->vertices.front())[0];
    CHECK(std::abs(told - slope) <= 4e-16 * std::abs(slope));
  }
}

TEST_CASE("an inf-convolution's subgradients are exact where those of its parts meet in fractions") {
  // At 3 norm1 goes 5/2 of the way with the slope 1, and at 1/4 none of it.
  for (const auto& [x, slope] : {std::pair{"3", Fraction{1}}, std::pair{"1/4", Fraction{1, 2}}}) {
    const Subdifferential found = at("inf_convolution(norm1(), translate(squared_norm2(2),[0]))", x);
    CHECK(found.is_exact);
    CHECK(found.polyhedron->vertices.front()[0] == slope);
  }
}

TEST_CASE("where no point attains an inf-convolution its slope is told, or a refusal, soon") {
  // It is 0 everywhere: the exponential has the slope 0 beyond all doubles alone.
  const Subdifferential flat = at("inf_convolution(zero(), exponential())", "0");
  REQUIRE(flat.is_single());
  CHECK(nearest(flat.polyhedron->vertices.front())[0] == 0);
  CHECK_THROWS_AS(at("inf_convolution(logistic(), inverse_power(1))", "0"), InvalidInput);
}
