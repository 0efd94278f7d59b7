#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Programs whose objective hardly falls along an edge, and numbers that leave the range of doubles on the
/// way.
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Status;
using convex::Vector;

TEST_CASE("the value of a conjugate is found where rows of a polyhedron nearly tell the same bound") {
  struct Asked {
    std::string f;
    Vector v;
    double truth;
  };
  // x >= -11 by the second row, and the first one tells nearly that; and so in a sum that cancels.
  const Asked asked[] = {
      {"indicator(polyhedron([[-1],[-2]],[11.000000000931323,22]))", Vector{{-1}}, 11},
      {"indicator(polyhedron([[-1],[-2]],[11.00000002,22]))", Vector{{-1}}, 11},
      {"indicator(polyhedron([[-1,0],[-2,0],[0,-1]],[1000000.00002,2e6,-1e6]))", Vector{{-1, -1}}, 0},
      {"max_affine([[-1],[-2],[1]],[-1000000.00002,-2e6,1e6])", Vector{{0}}, 0},
      {"indicator(polyhedron([[3],[1]],[-20999999.99999237,-7000000]))", Vector{{3.1}}, -21700000}};
  for (const auto& [f, v, truth] : asked) {
    CAPTURE(f);
    const convex::Value found = samples::function(f, v.size()).conjugate().evaluate(v);
    CHECK(std::abs(found.value - truth) <= found.error + 4e-16 * std::abs(truth));
    CHECK(found.error <= 1e-13 * std::max(1.0, std::abs(truth)));
  }
}

TEST_CASE("a maximum of which a part scaled by the least weight is beyond doubles is split all the same") {
  const auto f = samples::function(
      "pointwise_max(perspective(inf_convolution(linear([2]),elastic_net(3,0.25))),"
      "sum(translate(squared_distance(box([1,-1],[2,-1]),1),[-4096.5,1025.5]),constant(-8193.25)))",
      2);
  const auto split = convex::decompose(f, Vector{{-4094, 1024}}, Metric::identity(2));
  REQUIRE(split.status == Status::solved);
  CHECK((split.x.x - Vector{{-4096, 1024}}).norm() <= 1e-9);
}

TEST_CASE("where a term has no prox in doubles on the way the steps go on without") {
  const auto f = samples::function(
      "indicator(intersection(psd_cone(),epigraph(translate(perspective(kullback_leibler(3)),[-0.5,-1.5,-0.5]"
      "))))",
      4);
  const Metric W = Metric::diagonal(Vector{{2, 2, 1, 0.03125}});
  const auto split = convex::decompose(f, Vector{{1, 0, 0, -16.000030517578125}}, W);
  REQUIRE(split.status == Status::solved);
  CHECK((split.x.x - Vector{{1, 0, 0, 0}}).norm() <= 1e-9);
}

TEST_CASE("a root of a perspective that is all but 0 does not leave the range of doubles") {
  const auto f = samples::function(
      "indicator(intersection(polyhedron([[-3,1,-2],[2,1,0],[-1,1,-3]],[-12.5,7.5,0.5]),epigraph(sum("
      "translate("
      "inf_convolution(indicator(simplex(8)),tilt(inverse_power(1),[1.0625,1.0625])),[-7,-7.5]),constant(-12)"
      "))))",
      3);
  const Metric W = Metric::dense(Matrix{{4, 8, -4}, {8, 16.25, -8.25}, {-4, -8.25, 5.25}});
  const Vector z{{4.999921798706055, -3.4999608993530273, -2.9999990463256836}};
  const auto split = convex::decompose(f, z, W);
  REQUIRE(split.status == Status::solved);
  CHECK((split.x.x - Vector{{5, -3.5, -3}}).norm() <= 1e-9);
}
