#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "convex/functions/decomposition.hpp"
#include "convex/gamma0/node.hpp"
#include "tests/convex/operations/samples.hpp"

/// Answers that look right to the values at hand, and are not.
using namespace convex;

namespace {

struct Question {
  std::string f;
  std::vector<double> z, x;  ///< x as mpmath has it, to some 12 digits
};

Decomposition split_of(const Question& question) {
  const auto n = static_cast<Index>(question.z.size());
  const Vector z = Eigen::Map<const Vector>(question.z.data(), n);
  return decompose(samples::function(question.f, n), z, Metric::identity(n));
}

double error_of(const Decomposition& split, const Question& question) {
  const Vector x = Eigen::Map<const Vector>(question.x.data(), static_cast<Index>(question.x.size()));
  return (split.x.x - x).norm();
}

}  // namespace

TEST_CASE("a point is no member of an epigraph because the search for the nearest one gave up there") {
  // (x - 3s)²/(2s), whose three terms cancel where it is small: x = 0 was told, by a conjugate that seemed 0.
  const Question questions[] = {
      {"perspective(sum(squared_norm2(),constant(4.5),linear([-3])))",
       {0.00067, 0},
       {0.000603002019943, 0.000200996184535}},
      {"perspective(sum(squared_norm2(),constant(5000),linear([-100])))",
       {0.1, 0},
       {0.0999900010, 0.0009998999}},
      {"indicator(epigraph(dilate(log_barrier(),1e9)))", {1, -3}, {5.2242200450, 19.0698859454}}};
  for (const Question& question : questions) {
    CAPTURE(question.f);
    const Decomposition split = split_of(question);
    CHECK((split.status != Status::solved || error_of(split, question) <= 1e-8));
    CHECK(split.x.x.norm() > 0);
  }
}

TEST_CASE("what is told as nearest to z does not lie inside of the set") {
  // The values of a y of 3e-9 say nothing here: x was told as (2.8e-9, 0.5), a step away from the edge.
  const Question question{
      "indicator(epigraph(sum(log_barrier(),constant(-25))))", {0, 0.5}, {8.4234637545e-12, 0.5}};
  const Decomposition split = split_of(question);
  CHECK((split.status != Status::solved || error_of(split, question) <= split.error_bound));
}

TEST_CASE("no x is told that is worse than z itself") {
  // (5, 0) is inside: e⁵ - 5e9 < 0, and the slope of 1e9 puts a wrong covector within rounding of the domain.
  for (const char* f : {"indicator(epigraph(sum(exponential(),linear([-1e9]))))",
                        "indicator(epigraph(tilt(power(4),[-1e9])))"}) {
    CAPTURE(std::string(f));
    const Decomposition split = split_of({f, {5, 0}, {5, 0}});
    CHECK(split.status == Status::solved);
    CHECK(split.x.x == Vector{{5, 0}});
  }
}

TEST_CASE("an x outside the domain by more than rounding is not solved") {
  const Question question{
      "pointwise_max(indicator(box(0.1,2e6)),scale(sum(inverse_power(0.5),binary_entropy()),1e11))",
      {-0.328},
      {0.70098}};
  const Decomposition split = split_of(question);
  CHECK((split.status != Status::solved || error_of(split, question) <= 1e-4));
  CHECK(error_of(split, question) <= split.error_bound + 1e-4);
}

TEST_CASE("the slope of -log det is told by an inverse where its prox is near its point") {
  const Question questions[] = {{"sum(norm1(),envelope(neg_log_det(),1e-10))", {0.3}, {0.709481004927099}},
                                {"sum(huber(1),envelope(neg_log_det(),1e-10))", {0.3}, {0.786073132609496}},
                                {"sum(huber(1),envelope(neg_log_det(),1e-8))", {5}, {4.23606797737518}}};
  for (const Question& question : questions) {
    CAPTURE(question.f);
    const Decomposition split = split_of(question);
    CHECK(split.status == Status::solved);
    CHECK(error_of(split, question) <= 1e-11);
  }
}

TEST_CASE("a far normal of a set does not measure the heights of the maximum beside it") {
  // On the line of the simplex; the three functions tie at (570000, 1), where 1 and 7 are the slopes, and
  // the normal of 6e7 hid heights of 7: (569998.7, 2.3) was told, with a bound of 2e-7.
  const char* f =
      "sum(pointwise_max(pointwise_max(hinge(),sum(translate(huber(0.25),[570000.25,1.25]),constant(-0.25))),"
      "sum(translate(squared_hinge(),[570001.21875,-1]),constant(-4.9228515625))),"
      "translate(sum(indicator(simplex(3.375)),translate(ball2(19.375),[14.15625,16.34375])),"
      "[569997.46875,0.15625]))";
  for (const double far : {62400000.0, 624000000.0}) {
    const Question question{f, {570000 - 5.903125 - far, 1 - far - 3.35}, {570000, 1}};
    const Decomposition split = split_of(question);
    CHECK(split.status == Status::solved);
    CHECK(error_of(split, question) <= split.error_bound);
  }
}

TEST_CASE("a step of a search that leaves the range of doubles ends the search, not the question") {
  const Metric W = Metric::dense(Matrix{{2, 1}, {1, 2}});
  const Function f = samples::function(
      "proximal_average(pointwise_max(exponential(),sum(max(),constant(7000))),norm1())", W);
  const Decomposition split = decompose(f, Vector{{-4.5, 470}}, W);
  CHECK(split.status == Status::solved);
  CHECK((split.x.x - Vector{{2.11463277661919411, 238.731318989510176}}).norm() <= 1e-11);
}

TEST_CASE("a value that work cut short is denied by the other prox") {
  // f(z) is +inf: the cone's third entry is below 0 at z, and the entropy only takes from it.
  const Question question{
      "inf_convolution(precompose(indicator(epigraph(perspective(squared_norm2()))),[[0,2,0.5,1],[0,-1,0.5,0."
      "5],"
      "[2,1,0.5,2],[0,0.5,0,0.5]],[3,3,-1,-1.097]),tilt(sum(kullback_leibler(1),constant(-4)),[1,1,1,1]))",
      {0.5, -2.249, 2, -1e6},
      {122084.30967749853, 29632.93799008687, 993.8559611728454, -16038.28275243812}};
  const Decomposition split = split_of(question);
  CHECK(error_of(split, question) <= 1e-3);
}

TEST_CASE("no value of a conjugate is told that the supremum surpasses far out along its steps") {
  // Each a slope of f at a point of the cone that is exact in doubles, so that f* is known; the steps of the
  // search stood still beside 0, and -f(0) was told.
  struct Claim {
    const char* f;
    Vector v;
    double value;
  };
  const Claim claims[] = {
      {"sum(rotated_second_order_cone(),translate(norm1(1),[299,0,360001]))", Vector{{151, -179999, -1.0625}},
       -359702},
      {"sum(rotated_second_order_cone(),translate(log_sum_exp(),[-247.578125,209.875,238152.84375]))",
       Vector{{-487.0000040294566, -476288, -0.24999597054339862}}, -246.6175549},
      {"sum(sum(rotated_second_order_cone(),translate(log_sum_exp(),[3.5,1444,-2.875,226098.265625])),"
       "translate(hinge(),[0.75,294,1,226098.640625]))",
       Vector{{-1478.4999389581449, 1124082, -267250957.1696646, -2363.9241464505026}}, 17143.930278734}};
  for (const Claim& claim : claims) {
    const Function f = samples::function(claim.f, claim.v.size());
    const Value told = f.conjugate().evaluate(claim.v);
    CAPTURE(told.value);
    CHECK(std::abs(told.value - claim.value) <= told.error + 1e-6);
    // What is made of it has no less of an error.
    const Value twice = samples::function(std::string("scale(conjugate(") + claim.f + "),2)", claim.v.size())
                            .evaluate(claim.v);
    CHECK(std::abs(twice.value - 2 * claim.value) <= twice.error + 1e-6);
  }
  const Value plain = samples::function("norm1()", 2).conjugate().evaluate(Vector{{0.5, -1}});
  CHECK(plain.value == 0);
  CHECK(plain.error <= 1e-15);
}
