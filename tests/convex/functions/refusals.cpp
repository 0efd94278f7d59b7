#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "cli/function_language/parse_call.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/functions/decomposition.hpp"

using convex::InvalidInput;
using convex::Metric;
using convex::Space;
using convex::Vector;

namespace {

struct Refusal {
  std::string call;
  std::string message;  ///< a part of it
};

const Refusal refusals[] = {
    {"sum_largest(4)", "there are no 4 largest of 3 entries"},
    {"box(2, 1)", "empty"},
    {"box([0,0,0], [1,-1,1])", "entry 1"},
    {"box([0,0], [1,1])", "entries"},
    {"box(inf, inf)", "empty"},
    {"ball2(-1)", "ball2(radius): negative"},
    {"ball2(inf)", "ball2(radius): not finite"},
    {"ball1(-0.5)", "radius"},
    {"ball_inf(-1)", "radius"},
    {"simplex(-1)", "empty"},
    {"capped_simplex(4)", "empty"},
    {"capped_simplex(-1)", "empty"},
    {"halfspace([0,0,0], -1)", "empty"},
    {"hyperplane([0,0,0], 1)", "empty"},
    {"affine([[1,0,0],[1,0,0]], [0,1])", "affine"},
    {"affine([[1,0,0]], [0,1])", "entries"},
    {"polyhedron([[1,0,0],[-1,0,0]], [0,-1])", "polyhedron"},
    {"polyhedron([[1,0],[0,1]], [0,0])", "entries"},
    {"cone([[1,0],[0,1]])", "entries"},
    {"power_cone(0)", "alpha"},
    {"power_cone(1)", "alpha"},
    {"dual_power_cone(1.5)", "alpha"},
    {"norm1(-1)", "norm1(weight): negative"},
    {"norm1([1,-1,1])", "negative"},
    {"norm1([])", "norm1(weight): no entries"},
    {"linear([])", "linear(c): no entries"},
    {"ball2(1, [])", "ball2(center): no entries"},
    {"expm1([])", "expm1(weight): no entries"},
    {"kullback_leibler([])", "kullback_leibler(reference): no entries"},
    {"sorted_norm1([])", "sorted_norm1(weights): no entries"},
    {"norm2(-1)", "norm2(weight): negative"},
    {"norm_inf(-2)", "weight"},
    {"squared_norm2(-1)", "weight"},
    {"huber(0)", "mu"},
    {"huber(-1)", "mu"},
    {"elastic_net(-1, 1)", "l1"},
    {"elastic_net(1, -1)", "l2"},
    {"total_variation(-1)", "weight"},
    {"nuclear_norm(-1, 3)", "weight"},
    {"nuclear_norm(1, 2)", "rows"},
    {"nuclear_norm(1, 0)", "rows"},
    {"sum_largest(0)", "k"},
    {"sum_largest(4)", "sum_largest: there are no 4 largest of 3"},
    {"sum_largest(1.5)", "k"},
    {"power(0.5)", "p"},
    {"power(inf)", "p"},
    {"inverse_power(0)", "q"},
    {"negative_power(1)", "r"},
    {"kullback_leibler(-1)", "reference"},
    {"kullback_leibler([1,-1,1])", "reference"},
    {"group_norm(1, 2)", "groups"},
    {"group_norm(1, [2,2])", "entries"},
    {"sorted_norm1([1,2,3])", "weights"},
    {"quadratic([[1,2,0],[2,1,0],[0,0,1]])", "not positive semidefinite"},
    {"quadratic([[1,2,0],[0,1,0],[0,0,1]])", "not symmetric"},
    {"quadratic([[1,0,0],[0,1,0]])", "square"},
    {"quadratic([[1,0],[0,1]])", "entries"},
    {"quadratic([[1,0,0],[0,-1e-300,0],[0,0,1]])", "negative"},
    {"max_affine([[1,0,0]], [0,1])", "entries"},
    {"linear([1,2])", "entries"},
    {"plq([0], [[0,1,0],[0,-1,0]])", "convex"},
    {"plq([0], [[0,-1,0],[0,1,5]])", "differ"},
    {"plq([0], [[-1,0,0],[0,0,0]])", "convex"},
    {"plq([0], [[inf,0,0],[inf,0,0]])", "improper"},
    {"plq([1,0], [[0,0,0],[0,0,0],[0,0,0]])", "increas"},
    {"plq([0], [[0,0,0]])", "row"},
    {"psd_cone()", "square"},
    {"neg_log_det()", "square"},
    {"exponential_cone(1)", "too many"},
};

}  // namespace

TEST_CASE("what is no set, or not convex, closed and proper, is refused with what is wrong") {
  for (const Refusal& refusal : refusals) {
    CAPTURE(refusal.call);
    std::string message;
    try {
      convex::make_function(cli::parse_call(refusal.call, "f"), Space{Metric::identity(3)});
    } catch (const InvalidInput& error) {
      message = error.what();
    }
    CAPTURE(message);
    CHECK(message.find(refusal.message) != std::string::npos);
    CHECK(message.find(';') != std::string::npos);
  }
}

TEST_CASE("a point that is no point of the space is refused at the door") {
  const auto f =
      convex::make_function(cli::parse_call("quadratic([[1,0],[0,1]])", "f"), Space{Metric::identity(2)});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(f(Vector::Ones(3)), InvalidInput);
  CHECK_THROWS_AS(f(Vector::Constant(2, nan)), InvalidInput);
  CHECK_THROWS_AS(f.prox(Vector::Ones(2), Metric::identity(3)), InvalidInput);
  CHECK_THROWS_AS(f.subgradient(Vector::Ones(1)), InvalidInput);
  CHECK_THROWS_AS(f.is_subgradient(Vector::Ones(2), Vector::Ones(1)), InvalidInput);
  const auto max = convex::make_function(cli::parse_call("max()", "f"), Space{Metric::identity(1)});
  CHECK_THROWS_AS(max(Vector()), InvalidInput);
}

TEST_CASE("a sum of the three largest entries is a part of any function of three entries and more") {
  const Vector z{{1, 2, 3, 4}};
  for (const char* text :
       {"pointwise_max(norm1(), sum_largest(3))", "perspective(sum_largest(3))",
        "sum(squared_norm2(), sum_largest(4))", "conjugate(pointwise_max(max(), sum_largest(4)))"}) {
    CAPTURE(std::string(text));
    const auto f = convex::make_function(cli::parse_call(text, "f"), Space{Metric::identity(4)});
    CHECK(convex::decompose(f, z, Metric::identity(4)).status == convex::Status::solved);
  }
}
