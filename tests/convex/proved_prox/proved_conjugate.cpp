#include "convex/proved_prox/proved_conjugate.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/exact/ball.hpp"
#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/proved_prox/pair_of_call.hpp"
#include "convex/proved_prox/proved_metric.hpp"

using namespace convex;

namespace {

ProvedValue proved(const std::string& f, const Vector& y) {
  return proved_conjugate({cli::parse_call(f, "f"), fractions(y), identity_gram(at(y.size()))});
}

/// u log u - u, the conjugate of e^x.
double of_exponential(double u) { return u * std::log(u) - u; }

struct Known {
  std::string f;
  Vector y;
  double value;
};

/// By hand; the two of more digits by mpmath 1.2, at the roots of x e^x = 1 and 2 - 2 e^(2x + 1) = x.
const std::vector<Known> known_values = {
    {"sum(norm2(), norm1())", Vector{{0.5, 0.25}}, 0},
    {"sum(squared_norm2(), norm2())", Vector{{3, 4}}, 8},
    {"sum(squared_norm2(), norm2(), linear([1, 1]))", Vector{{4, 5}}, 8},
    {"sum(entropy(), indicator(simplex(1)))", Vector{{0, 0, 0}}, std::log(3)},
    {"sum(exponential(), linear([1, 2]))", Vector{{2, 3}}, -2},
    {"sum(exponential(), norm1())", Vector{{3}}, of_exponential(2)},
    {"sum(exponential(), norm1())", Vector{{3, 0.25, -0.5}}, of_exponential(2) - 1 + of_exponential(0.5)},
    {"sum(log_barrier(), squared_norm2())", Vector{{0, 0}}, -1},
    {"sum(log_barrier(), exponential(), linear([1]))", Vector{{1}}, -2.3303661247616806},
    {"precompose(exponential(), [[1, 0], [1, 1]], [0, 0])", Vector{{1.5, 0.25}},
     of_exponential(1.25) + of_exponential(0.25)},
    {"sum(precompose(exponential(), [[2]], [1]), squared_norm2())", Vector{{2}}, -2.1012464679202249},
    {"translate(sum(squared_norm2(), norm2()), [1, 2])", Vector{{3, 4}}, 19},
    {"scale(sum(squared_norm2(), norm2()), 2)", Vector{{6, 8}}, 16},
    {"sum(indicator(ball2(1)), indicator(orthant()))", Vector{{3, -1}}, 3},
    {"sum(indicator(ball2(1)), indicator(orthant()), linear([0, 2]))", Vector{{3, 6}}, 5},
    {"sum(exponential(), indicator(ball2(1)), indicator(orthant()))", Vector{{3, -1}}, 2 - std::exp(1.0)},
    {"sum(norm2(1), norm_inf(9), squared_norm2())", Vector{{1, 2, -2}}, 0},
};

}  // namespace

TEST_CASE("the conjugate of a sum is held between a point and the covectors that its parts take") {
  if (!Ball::why_none().empty()) return;
  for (const Known& known : known_values) {
    CAPTURE(known.f);
    const ProvedValue value = proved(known.f, known.y);
    CAPTURE(value.why_none);
    REQUIRE(value.level != ProofLevel::none);
    const double rounding = 4 * unit_roundoff * std::max(1.0, std::abs(known.value));
    CHECK(value.interval.low <= known.value + rounding);
    CHECK(value.interval.high >= known.value - rounding);
    CHECK(value.interval.high - value.interval.low <= 2 * rounding);
  }
}

TEST_CASE("a conjugate is held between a point and a split of the covector however far off the point is") {
  if (!Ball::why_none().empty()) return;
  for (const Known& known : known_values)
    for (const double off : {0.0, 0.125, -0.25}) {
      const Fractions v = fractions(known.y);
      const Vector x = Vector::Constant(known.y.size(), 0.5 + off);
      const PairSearch found =
          pair_at_covector(cli::parse_call(known.f, "f"), identity_gram(v.size()), fractions(x), v);
      if (!found.pair) continue;
      CAPTURE(known.f);
      CAPTURE(off);
      const double rounding = 4 * unit_roundoff * std::max(1.0, std::abs(known.value));
      CHECK(found.pair->v == v);
      CHECK(nearest_double(found.pair->f_v.high) >= known.value - rounding);
      CHECK(nearest_double(dot(found.pair->x, v) - found.pair->f_x.high) <= known.value + rounding);
    }
}

TEST_CASE("of a supremum that no point attains, or that is infinite, a proof says that it has none") {
  if (!Ball::why_none().empty()) return;
  const ProvedValue value = proved("sum(norm2(), norm1())", Vector{{1.5, 2.25}});
  CHECK(value.level == ProofLevel::none);
  CHECK(value.why_none.find("+inf") != std::string::npos);
}

TEST_CASE(
    "the value of a conjugate whose domain is one point counts the roundings of its terms, which cancel") {
  // f has the point 1/2 alone: f*(v) = v/2 - f(1/2), here -1/8 + 2 log(3/2) - log 2 (mpmath 1.2).
  const std::string f =
      "sum(scale(translate(log_barrier(), [-1]), 2), indicator(simplex(0.5)), log_barrier())";
  const Vector y{{-0.25}};
  const Metric plain = Metric::identity(1);
  const Call call = cli::parse_call(f, "f");
  const Value told =
      decided_conjugate({call, fractions(y), exact_gram(plain)}, make_function(call, {plain}).conjugate(), y);
  constexpr double truth = -0.0072169643436165455;
  CHECK(told.error <= 1e-15);
  CHECK(std::abs(told.value - truth) <= told.error);
}

TEST_CASE("a proof beside a point of e^-3000 and less is no defect") {
  if (!Ball::why_none().empty()) return;
  const ProvedValue value = proved("sum(norm2(0.5), norm1(9540), scale(entropy(), 3), hinge())",
                                   Vector{{0.697253219703444, 0.8993131505962837, 2.7625051350845986}});
  CHECK(value.level == ProofLevel::enclosure);
  CHECK(value.interval.low <= -3);
  CHECK(value.interval.high >= -3);
}
