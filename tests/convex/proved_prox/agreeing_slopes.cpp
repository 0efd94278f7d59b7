#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/proved_prox/proved_conjugate.hpp"
#include "convex/proved_prox/proved_metric.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Metric;
using convex::Value;
using convex::Vector;

namespace {

struct SupremumFarOut {
  const char* f;
  Vector v;
  double value;  ///< by an exact linear program of its own
};

/// The value of the conjugate at v, as it is told.
Value told(const char* f, const Vector& v) {
  const Metric W = Metric::identity(v.size());
  return convex::decided_conjugate({cli::parse_call(f, "f"), convex::fractions(v), convex::exact_gram(W)},
                                   samples::function(f, W).conjugate(), v);
}

}  // namespace

TEST_CASE("slopes that agree but for roundings have the supremum that they have, however far out it is") {
  const SupremumFarOut questions[] = {
      {"max_affine([[4],[3.9999999999999964]], [0,0.33333333333299997])", Vector{{4}}, 0},
      {"precompose(norm_inf(1), [[4],[3.9999999999999964],[0.3333333333333333]], [0,0.33333333333299997,4])",
       Vector{{4}}, 0},
      {"inf_convolution(precompose(indicator(hyperplane([0.09999999999999991,-2], 0.0999999)), "
       "[[3,4],[0,-1]], [2,1]), precompose(norm1(0.3333333333333333), "
       "[[1,-0.5],[1.0000000000000002,-0.5]], [3.0000000000030003,0.5]))",
       Vector{{0, 0}}, 0},
      {"precompose(inf_convolution(norm_inf(1.999999999999998), max_affine([[1,1],"
       "[0.001000000000000001,0.0010000000000000009],[1.9999999998,2.000000000002]], "
       "[-1,1.000000000001,0.3333333333333333])), [[0.33333333333333326],[-0.3333333332999999]], "
       "[0.5000000004656613,-0.7000000000000001])",
       Vector{{0}}, -0.9490119164255143},
  };
  for (const SupremumFarOut& question : questions) {
    const Value value = told(question.f, question.v);
    CAPTURE(std::string(question.f));
    CAPTURE(value.value);
    CHECK(std::abs(value.value - question.value) <= value.error + 1e-15 * std::abs(question.value));
    CHECK(value.error <= 1e-5);
  }
}

TEST_CASE("beside a curved function the supremum of slopes that agree but for roundings is as far out") {
  const char* const f =
      "sum(exponential(), max_affine([[0.1],[0.10000000001],[0.10000000001]], [0.25,0.001,0.75]))";
  // The supremum is at the kink x = -1/2 / (c - a), where e^x is 0: it is (y - a) x - 1/4.
  const double a = 0.1, c = 0.10000000001, x = -0.5 / (c - a);
  for (const double y :
       {0.1, 0.1000000000001, 0.1000000000099, 0.100000000009999, 0.1000000000099999, 0.10000000000999999}) {
    const Value value = told(f, Vector{{y}});
    CAPTURE(value.value);
    CHECK(std::abs(value.value - ((y - a) * x - 0.25)) <= value.error + 1e-15);
    CHECK(value.error <= 1e-12);
  }
}

TEST_CASE("the supremum of two entries is the sum of both, however far out the kinks of the one are") {
  const char* const one = "sum(exponential(), max_affine([[1],[1.0000000000001]], [-0.5,1]))";
  const char* const other = "sum(exponential(), max_affine([[0.5],[2]], [1,0]))";
  const char* const both =
      "sum(exponential(), max_affine([[1,0.5],[1.0000000000001,0.5],[1,2],[1.0000000000001,2]], "
      "[0.5,2,-0.5,1]))";
  const Value first = told(one, Vector{{1.00000000000002}}), second = told(other, Vector{{1.25}}),
              whole = told(both, Vector{{1.00000000000002, 1.25}});
  CHECK(std::abs(first.value - 0.2) < 1e-2);
  CHECK(std::abs(whole.value - first.value - second.value) <= whole.error + first.error + second.error);
  CHECK(whole.error <= 1e-12);
}

TEST_CASE("a maximum with a curved function is as far out where its lines agree but for roundings") {
  const char* const f = "pointwise_max(exponential(), max_affine([[-0.5],[-0.500000000001]], [0.25,0]))";
  const double a = -0.5, c = -0.500000000001, x = 0.25 / (c - a);
  for (const double y : {-0.5000000000005, -0.5000000000009}) {
    const Value value = told(f, Vector{{y}});
    CAPTURE(value.value);
    CHECK(std::abs(value.value - ((y - a) * x - 0.25)) <= value.error + 1e-15);
    CHECK(value.error <= 1e-12);
  }
}

TEST_CASE("what the roundings of numbers make of a value is its error") {
  // The double 0.1 is above a tenth by a part of what the slopes differ by, and is the first one rounded.
  const Value value = told("max_affine([[0.1],[0.1000000000000001]], [0,-100000000])", Vector{{0.1}});
  CHECK(std::abs(value.value) <= value.error);
  CHECK(value.error > 1e6);
}

TEST_CASE("a point that a rounding puts outside keeps the value beside it, and one farther out has none") {
  const char* const highest = "max_affine([[1,0],[0,1]])";
  CHECK(told(highest, Vector{{0.1, 0.9}}).value == doctest::Approx(0));
  CHECK(told(highest, Vector{{1.0 / 3, 0.66666666666666674}}).value == doctest::Approx(0));
  CHECK(told(highest, Vector{{0.1, 0.91}}).value == INFINITY);
}

TEST_CASE("a supremum at the origin, where no point is beside it, has its value") {
  const SupremumFarOut questions[] = {{"sum(huber(3), power(3))", Vector{{0}}, 0},
                                      {"sum(huber(3), power(3), exponential())", Vector{{1}}, -1}};
  for (const SupremumFarOut& question : questions) {
    const Value value = told(question.f, question.v);
    CAPTURE(std::string(question.f));
    CHECK(std::abs(value.value - question.value) <= value.error);
    CHECK(value.error <= 1e-12);
  }
}

TEST_CASE("bounds by fractions end where numbers of 1e-40 beside 1 have squares beyond doubles") {
  const char* const f = "sum(precompose(scale(negative_power(0.5), 1e-20), [[1,1]]), squared_norm2())";
  // With s = x_1 + x_2 it is the largest of -s + 1e-20 sqrt(s) - s²/4: 2.5e-41, nearly.
  const Value value = told(f, Vector{{-1, -1}});
  CHECK(std::abs(value.value - 2.5e-41) <= value.error);
  CHECK(value.error <= 1e-12);
}

TEST_CASE("the conjugate of a square with a root of 1e-20 is told to roundings") {
  const char* const f = "sum(precompose(scale(negative_power(0.5), 1e-20), [[1,1]]), squared_norm2())";
  for (const Vector& v : {Vector{{1, 0.5}}, Vector{{1, 1}}, Vector{{-1, 1}}, Vector{{3, -1}}}) {
    const Value value = told(f, v);
    CAPTURE(v.transpose());
    CHECK(std::abs(value.value - 0.5 * v.squaredNorm()) <= value.error + 1e-19);
    CHECK(value.error <= 1e-14);
  }
}
