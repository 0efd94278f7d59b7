#include <doctest/doctest.h>

#include <cmath>

#include "convex/functions/decomposition.hpp"
#include "convex/operations/operations.hpp"
#include "tests/convex/operations/samples.hpp"

/// Maxima of functions as steep as 4e9: heights in units of 1 hide what is missed.
using convex::Function;
using convex::Metric;
using convex::Prox;
using convex::Value;
using convex::Vector;
using samples::function;

namespace {

const char* const steep_maximum =
    "sum(power(1.75), pointwise_max(norm1(3.82e9), precompose(kullback_leibler(1), [[0,-1]], [3])))";

/// Norm1 is the larger there: x + 1.75 |x|^0.75 = 539 and 93025, entry by entry.
const Vector z{{-3820000539, -3820093025}}, x{{-386.46468375, -84362.37254652}};

}  // namespace

TEST_CASE("a prox of a maximum of steep functions is within its bound, and that of its conjugate") {
  const Function f = function(steep_maximum, 2);
  const Metric W = Metric::identity(2);
  const Prox of_f = f.prox(z, W), of_g = f.conjugate().prox(z, W);
  constexpr double of_x = 1e-7;  // as it is written above
  CHECK((of_f.x - x).norm() <= of_f.error_bound + of_x);
  CHECK((of_g.x - (z - x)).norm() <= of_g.error_bound + of_x);
  CHECK(of_f.error_bound <= 1e-4);
  const convex::Decomposition split = convex::decompose(f, z, W);
  CHECK((split.x.x - x).norm() <= split.error_bound + of_x);
}

TEST_CASE("a conjugate of a sum with a maximum of steep functions is within its error") {
  struct Planted {
    const char* f;
    Vector v;
    double value;  ///< u·v - f(u) at the u that v is a subgradient at
  };
  const Planted questions[] = {
      {"sum(power(1.75), squared_norm2(0.0165), pointwise_max(dilate(norm1(955000000.0), 0.25), "
       "precompose(scale(kullback_leibler(0.000164), 1.5e-08), [[0,0,-1]], [3.625])))",
       Vector{{-3820000539.2710667, -3820093025.5695114, -3820003269.0769815}}, 57129916599.278046502},
      {"sum(pointwise_max(squared_distance(box(-1.6875, 0.6875), 0.0199), scale(scale(linear([-0.125,0.0625,"
       "-1.375]), 4080000), 9.55)), power(1.1), squared_norm2(0.00497))",
       Vector{{-4870501.028821291, 2435251.2179790493, -53575500.00000001}}, 0.33679370661060498},
  };
  for (const Planted& question : questions) {
    const Value found = function(question.f, question.v.size()).conjugate().evaluate(question.v);
    CAPTURE(question.f);
    CAPTURE(found.value);
    CHECK(std::abs(found.value - question.value) <= found.error);
  }
}
