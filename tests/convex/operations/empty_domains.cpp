#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "convex/invalid_input.hpp"
#include "tests/convex/operations/samples.hpp"

using convex::Metric;
using convex::Status;
using convex::Vector;

namespace {

struct Expression {
  const char* f;
  convex::Index n;
};

/// Each empty for a reason that one can see: the comment says it.
constexpr Expression without_points[] = {
    // -3x > 1, 3x > -1
    {"precompose(inverse_power(1), [[-3],[-2],[3]], [-1,3,1])", 1},
    {"precompose(inverse_power(1), [[-3],[-2],[0]], [1,2,0])", 1},               // 0 > 0
    {"pointwise_max(dilate(inverse_power(1), -2), perspective(entropy()))", 2},  // x < 0 and x >= 0
    {"sum(pointwise_max(inverse_power(1), conjugate(hinge())), power(2))", 2},   // x > 0 and x <= 0
    // x_2 = 3 + 2 x_1 leaves (0, 3, 0) of the simplex, which is not in the cone
    {"indicator(intersection(hyperplane([2,-1,0], -3), intersection(simplex(3), second_order_cone())))", 3},
    // the epigraphs and the box have (1, 0, 2) in common, where 3x + 2y + 3t = 9
    {"pointwise_max(indicator(intersection(hyperplane([3,2,3], 2), box(-1,2))), "
     "indicator(intersection(epigraph(norm2(2)), epigraph(max_affine([[-1,0]], [3])))))",
     3},
    // slopes (3,1,-3,2) + t (3,0,-2,-2), at least sqrt(15.8) long, and those of length 2 at most
    {"inf_convolution(quadratic([[9,0,-6,-6],[0,0,0,0],[-6,0,4,4],[-6,0,4,4]], [3,1,-3,2]), "
     "distance(ball_inf(1), 2))",
     4},
    {"precompose(perspective(norm2(1)), [[3],[3],[0]], [-3,-1,-3])", 1},  // s = -3
    // 3x > 0 and -2x > 0, in an epigraph
    {"precompose(pointwise_max(huber(1024), inverse_power(0.5)), [[1],[3],[-2]], [1,0,0])", 1},
    {"precompose(pointwise_max(norm1(), log_barrier()), [[-3],[0],[-3]], [3,0,3])", 1},  // 0 > 0
    {"precompose(indicator(ball2(1, [0,1])), [[3],[0]], [0,-0.25])", 1},                 // 5/4 away
    // slopes of one sign, and slopes strictly of the other
    {"inf_convolution(distance(box(-inf,1), 1024), negative_power(0.5))", 4},
};

/// Domains that meet in little: a point, a ray, a strip of 2^-40.
constexpr Expression with_few_points[] = {
    {"precompose(inverse_power(1), [[-1],[1]], [1,-0.99999999999909050530])", 1},
    {"indicator(intersection(ball2(1, [0,-1]), hyperplane([3,0], -3)))", 2},
    {"indicator(intersection(box(-1,2), ball2(1, [3,-1])))", 2},
    {"precompose(indicator(ball2(1, [-1,3])), [[0],[-2]], [-2,0])", 1},
    {"precompose(pointwise_max(norm1(), log_barrier()), [[-3],[1e-6]], [3,0])", 1},
    {"indicator(intersection(second_order_cone(), affine([[1,0,0,-1]], 0)))", 4},
    {"sum(log_barrier(), indicator(halfspace([1,1], 1e-6)))", 2},
    {"inf_convolution(distance(hyperplane([-2,2,-3,1], 1), 2), inverse_power(1))", 4},
};

}  // namespace

TEST_CASE("a function that no point has finite is refused, open ends and slow separations included") {
  for (const auto& [f, n] : without_points) {
    CAPTURE(f);
    CHECK_THROWS_AS(samples::function(f, n), convex::InvalidInput);
  }
}

TEST_CASE("domains that touch, or overlap by little, are no reason to refuse a function") {
  for (const auto& [f, n] : with_few_points) {
    CAPTURE(f);
    CHECK_NOTHROW(samples::function(f, n));
  }
}

TEST_CASE("a ball that touches a plane has one nearest point, and a split that says so") {
  const Vector z = Eigen::Vector2d(1e8, -3e8);
  const Metric W = Metric::diagonal(Eigen::Vector2d(1, 9));
  const auto f = samples::function("indicator(intersection(ball2(1, [0,-1]), hyperplane([3,0], -3)))", W);
  const convex::Decomposition split = convex::decompose(f, z, W);
  CHECK(W.norm(split.x.x - Eigen::Vector2d(-1, -1)) <= split.error_bound);
}
