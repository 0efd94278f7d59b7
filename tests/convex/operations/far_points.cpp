#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Points far above what is left of them, in metrics that couple their entries: doubles of the larger part
/// carry no digit of the smaller one. And expressions whose values, or one of whose proxes, programs alone do
/// not tell.
using convex::Decomposition;
using convex::Matrix;
using convex::Metric;
using convex::Status;
using convex::Vector;

namespace {

struct Question {
  const char* f;
  std::vector<double> z;
  std::vector<double> gram;  ///< by rows; empty for the identity
};

const Question questions[] = {
    {"indicator(hyperplane([1,1], 1))", {-2, 3e8}, {4, 2, 2, 10}},
    {"inverse_power(1)", {-2e8, -3e8, -1e8}, {4, 6, -16, 6, 18, -15, -16, -15, 74}},
    {"max()", {-1e8, -3, -1e8, -1e8}, {1, 2, 3, -3, 2, 13, 0, -12, 3, 0, 14, -4, -3, -12, -4, 18}},
    {"indicator(affine([[-1,1,3],[-1,0,1]], 0))", {-3e8, -2e8, 1e8}, {4, -4, 2, -4, 5, -4, 2, -4, 9}},
    {"separable(log_barrier(), 2, norm2(3), 1)", {-3e8, 1e8, 1e8}, {9, -3, 6, -3, 2, 0, 6, 0, 12}},
    {"indicator(second_order_cone())", {2e8, 1e8, 2e8}, {4, -4, -2, -4, 13, 26, -2, 26, 69}},
    {"translate(scale(perspective(logistic()), 0.0009765625), [3,2])", {-2e8, 1e8}, {4, 0, 0, 4}},
    {"perspective(quadratic([[9,-6,9],[-6,4,-6],[9,-6,9]], [3,3,3]))", {1, 1, 1e-6, -3}, {}},
    {"scale(scale(quadratic([[4,-6],[-6,9]], [1,1]), 1024), 2)", {-3, -3e8}, {}},
    {"pointwise_max(tilt(translate(total_variation(3), [0,3,0,0.5]), [0,-3,1,0]), "
     "indicator(epigraph(sum(expm1(2), max()))))",
     {30223.241, -34008.046, 9930.502, 3},
     {2, 0, 1.25, 0.5, 0, 2.75, 0.75, -0.5, 1.25, 0.75, 3.5, 0.5, 0.5, -0.5, 0.5, 1.75}},
    {"precompose(log_barrier(), [[-3,2,-1],[-3,2,2],[-3,-1,1]], [-1,3,-2])",
     {-3e8, -3e8, -3e8},
     {4, 0, -2, 0, 9, 6, -2, 6, 14}},
    {"precompose(sum_largest(3), [[0,2,2,2],[1,3,3,3],[-2,3,2,3]], [-3,1,-3])",
     {0, -2e8, 1e8, 3e8},
     {9, 24, 9, 24, 24, 65, 22, 63, 9, 22, 22, 17, 24, 63, 17, 78}},
    {"sum(pointwise_max(envelope(power(2), 1), sum(elastic_net(0.5, 0.25), hinge())), "
     "plq([-1,1], [[0,-1,0],[1,0,0.5],[0,1,0]]))",
     {-3e8, -3e8, -2e8, 2e8},
     {9, 9, 3, 24, 9, 13, 1, 40, 3, 1, 3, 3, 24, 40, 3, 146}},
    {"perspective(perspective(negative_power(0.5)))",
     {8.42992849508192, -3, -3.654535297124088, -1},
     {1, 8, -1, 8, 8, 65, -7, 66, -1, -7, 11, 3, 8, 66, 3, 86}},
    {"pointwise_max(perspective(perspective(logistic())), hinge())", {-1, -1, -1}, {}},
    {"sum(norm1(1), inverse_power(0.5))", {1e8, -1e8}, {0.5, 0, 0, 2}},
    {"pointwise_max(norm1(0.25), inverse_power(1))", {3e8, -3e8}, {0.5, 0, 0, 1}},
    {"pointwise_max(distance(simplex(3), 2), inverse_power(1))", {-2e8, 2e8}, {}},
    {"perspective(sum(inverse_power(0.5), huber(0.5)))", {8.629812436588693, -2.5855654530083605, 2}, {}},
    {"sum(indicator(box(0,inf)), inverse_power(0.5))", {-1e8}, {10}},
    {"sum(norm2(1024), inverse_power(0.5))", {-2e8, -2e8}, {}},
    {"squared_distance(intersection(second_order_cone(), simplex(0.0009765625)), 0.25)", {-3e8, -3e8}, {}},
    {"inf_convolution(pointwise_max(huber(0.5), squared_hinge()), elastic_net(3, 0.125))",
     {2e8, 1, -3e8},
     {}},
    {"inf_convolution(hinge(), inverse_power(0.5))", {3e8, 3e8, 2}, {10, 0, 0, 0, 0.5, 0, 0, 0, 2}},
    {"perspective(pointwise_max(envelope(power(2), 1024), inf_convolution(max_affine([[2,1],[0,1]], "
     "[-1,-3]), "
     "kullback_leibler(2))))",
     {-2e8, -2e8, -3e8},
     {4, 0, -16, 0, 1, 0, -16, 0, 68}},
    {"pointwise_max(sum_largest(1), entropy())", {-1, -2e8, -2e8, -2e8}, {}},
    {"perspective(pointwise_max(quadratic([[1,1],[1,1]], [-1,2]), dilate(huber(3), 0.0009765625)))",
     {2e8, 1, -3e8},
     {0.03125, 0, 0, 0, 0.03125, 0, 0, 0, 0.03125}},
    {"perspective(pointwise_max(entropy(), exponential()))",
     {2.019308175375862, 9.922587492261805, -0.10601748343867712, -0.710620986652339},
     {1, -1, 0, 0, -1, 10, 9, 9, 0, 9, 13, 7, 0, 9, 7, 19}},
    {"perspective(conjugate(pointwise_max(quadratic([[1]],[1]), sum_largest(1))))",
     {-2, -2},
     {4, -6, -6, 13}},
    {"proximal_average(zero(), indicator(epigraph(logistic())), 0.5, 1)",
     {-40, -40, -20},
     {1, -1, -2, -1, 10, -4, -2, -4, 12}},
    {"inf_convolution(norm1(0.5), distance(hyperplane([0,1,3,2], 3), 1))",
     {3, 3, 1, 1},
     {9, 24, 0, 6, 24, 68, 2, 22, 0, 2, 10, 0, 6, 22, 0, 23}},
    {"inf_convolution(max_affine([[-2],[-1],[-1],[0]], [1,0,0,1]), power(2))", {0}, {}},
    {"envelope(perspective(quadratic([[9,-9,6],[-9,9,-6],[6,-6,4]], [2,-1,3])), 1)", {2, 3, -2, -1}, {}},
    {"translate(scale(norm1(), 2), 1)", {1e98}, {0.11}},
    {"pointwise_max(envelope(linear([1.69, 1.52]), 2.46), envelope(envelope(power(4), 0.65), 2.78))",
     {1.9e-9, 2e-8},
     {3.48, 0, 0, 3.79}},
    {"tilt(dilate(inf_convolution(squared_distance(orthant(), 1), negative_power(0.5)), 0.0009765625), "
     "[2,1,1,1])",
     {-2, -3, 0, 1e8},
     {0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0.03125}},
    {"proximal_average(dilate(pointwise_max(quadratic([[9,-9,9],[-9,9,-9],[9,-9,9]], [2,-2,3]), "
     "max_affine([[1,-3,3],[3,3,1]], [-2,2])), 0.0009765625), perspective(perspective(indicator(ball2(1, "
     "[-3])))), 0.5, 1)",
     {2, 2, 2},
     {2, 0, 0, 0, 1, 0, 0, 0, 0.03125}},
    {"pointwise_max(proximal_average(binary_entropy(), power(1.5), 0.5, 2), "
     "inf_convolution(squared_distance(polyhedron([[2],[1]], [1,5]), 3), squared_norm2(3)))",
     {0},
     {}},
    {"perspective(inf_convolution(sum(squared_norm2(2), hinge()), envelope(negative_power(0.5), 1024)))",
     {3e8, 3e8, -1e8},
     {}},
    {"precompose(sum(elastic_net(3, 2), inverse_power(1)), [[-3,-2],[3,2]], [1,3])", {-2, 3e8}, {}},
    {"tilt(indicator(ball2(1, [0,-1])), [-2,-1])", {-1, 3e8}, {}},
    // Their proxes take more than half of what a look may.
    {"pointwise_max(perspective(quadratic([[9,9,9],[9,9,9],[9,9,9]], [1,2,2])), proximal_average(entropy(), "
     "total_variation(2), 0.5, 1))",
     {-3e6, -3e6, -3e6, -3e6},
     {}},
    {"pointwise_max(conjugate(perspective(power(3))), proximal_average(precompose(zero(), [[-1,-3,-2,0]], "
     "[-3]), proximal_average(distance(affine([[-2,2,2,-1]], 0), 1), zero(), 0.5, 1), 0.5, 0.125))",
     {-3e8, 3e8, 0, 0},
     {9, -6, 6, -3, -6, 5, -7, -1, 6, -7, 17, 9, -3, -1, 9, 20}},
};

}  // namespace

TEST_CASE("a factor whose square is no double is a factor all the same") {
  // alpha lse moves z by alpha softmax(z) in length, and its conjugate's prox is that.
  const Vector z{{1, 2}};
  for (const char* f :
       {"scale(log_sum_exp(),1e-200)", "scale(max(),1e-200)", "scale(scale(norm2(),1e-200),0.5)"}) {
    CAPTURE(std::string(f));
    const auto split = convex::decompose(samples::function(f, 2), z, Metric::identity(2));
    CHECK(split.status == Status::solved);
    CHECK((split.x.x - z).norm() <= 1e-15);
    const auto turned =
        convex::decompose(samples::function(std::string("conjugate(") + f + ")", 2), z, Metric::identity(2));
    CHECK(turned.status == Status::solved);
    CHECK(turned.x.x.norm() <= 1e-15);
  }
  // The slope (1, 2) beside it moves z to 0.
  for (const char* f : {"tilt(scale(log_sum_exp(),1e-200),[1,2])",
                        "sum(proximal_average(scale(log_sum_exp(),1e-200),zero()),linear([1,2]))"}) {
    CAPTURE(std::string(f));
    const auto split = convex::decompose(samples::function(f, 2), z, Metric::identity(2));
    CHECK(split.status == Status::solved);
    CHECK(split.x.x.norm() <= 1e-15);
  }
}

TEST_CASE("a split of a point far above its parts is solved, and its values agree") {
  for (const Question& question : questions) {
    CAPTURE(std::string(question.f));
    const auto n = static_cast<convex::Index>(question.z.size());
    const Vector z = Eigen::Map<const Vector>(question.z.data(), n);
    const Metric W = question.gram.empty()
                         ? Metric::identity(n)
                         : Metric::dense(Eigen::Map<const Matrix>(question.gram.data(), n, n));
    const Decomposition split = convex::decompose(samples::function(question.f, W), z, W);
    CHECK(split.status == Status::solved);
    const double size = std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner), 1e-3});
    CHECK(std::abs(split.f_x + split.g_y - split.inner) <= 1e-9 * size);
    CHECK(split.residual <= 1e-9 * (W.norm(z) + W.norm(split.x.x)));
  }
}

TEST_CASE("the apex of a cone is not told for a point of it that the bound does not reach") {
  // z = x + t W^-1 n with (x, n) of a Moreau pair: x = (3,4,5) on the cone |(x_1,x_2)| <= x_3, n = (3,4,-5)
  // normal there.
  const Metric W = Metric::dense((Matrix(3, 3) << 20, -17, -9, -17, 18, 7, -9, 7, 6).finished());
  const Vector x = Eigen::Vector3d(3, 4, 5), n = Eigen::Vector3d(3, 4, -5);
  for (const double t : {1.0, 1e3, 1e6, 1e7, 1e8, 1e9}) {
    CAPTURE(t);
    const Vector z = x + t * W.solve(n);
    const Decomposition split =
        convex::decompose(samples::function("indicator(second_order_cone())", W), z, W);
    CHECK(W.norm(split.x.x - x) <= split.error_bound + 0x1p-50 * W.norm(z));
  }
}

TEST_CASE("a far point's nearest one on a line is that of exact arithmetic") {
  // x = (a, 1 - a) with (1, -1)·W(x - z) = 0, that is 2 (a - z_1) - 8 (1 - a - z_2) = 0.
  const Vector z = Eigen::Vector2d(-2, 3e8);
  const Metric W = Metric::dense(Matrix{{4, 2}, {2, 10}});
  const Decomposition split =
      convex::decompose(samples::function("indicator(hyperplane([1,1], 1))", W), z, W);
  const double a = (2 * z[0] - 8 * z[1] + 8) / 10;
  CHECK((split.x.x - Eigen::Vector2d(a, 1 - a)).norm() <= 1e-15 * 1e9);
}

TEST_CASE("a conjugate far out keeps the part of its function that is small beside the slope") {
  // (x + 2)²/2 on [0, 2], else +inf: at the slope v > 4 the supremum is 2v - 8.
  const auto g =
      samples::function("translate(pointwise_max(squared_norm2(1), indicator(ball2(1, [3]))), [-2])", 1)
          .conjugate();
  for (const double v : {5.0, 1e4, 99999998.0}) {
    CAPTURE(v);
    const convex::Value found = g.evaluate(Vector::Constant(1, v));
    CHECK(std::abs(found.value - (2 * v - 8)) <= found.error + 1e-15 * v);
    CHECK(found.error <= 1e-9 * v);
  }
}

TEST_CASE("the value of a convolution by entries is that of each") {
  // inf over w of max(0, 1 - w) + 1/sqrt(x - w): w = 1 where the slope of the root beyond it is below 1.
  const auto f = samples::function("sum(inf_convolution(hinge(), inverse_power(0.5)), constant(7))", 3);
  const convex::Value found = f.evaluate(Eigen::Vector3d(1e4, 1e4, 2));
  CHECK(std::abs(found.value - (8 + 2 / std::sqrt(1e4 - 1))) <= found.error + 1e-15);
  CHECK(found.error <= 1e-12);
}

TEST_CASE("roots in roots end, and what they leave is said") {
  for (const Question& question :
       {Question{"perspective(pointwise_max(envelope(power(2),1024),inf_convolution(max_affine([[2,1],[0,1]],"
                 "[-1,-3]),"
                 "kullback_leibler(2))))",
                 {-2e8, -2e8, -3e8},
                 {4, 0, -16, 0, 1, 0, -16, 0, 68}},
        Question{
            "pointwise_max(perspective(dilate(max_affine([[-3,-1,3],[-2,-2,-3]],[3,2]),0.125)),power(3))",
            {0, 0, 2, -3e-6},
            {}}}) {
    CAPTURE(std::string(question.f));
    const auto n = static_cast<convex::Index>(question.z.size());
    const Vector z = Eigen::Map<const Vector>(question.z.data(), n);
    const Metric W = question.gram.empty()
                         ? Metric::identity(n)
                         : Metric::dense(Eigen::Map<const Matrix>(question.gram.data(), n, n));
    const Decomposition split = convex::decompose(samples::function(question.f, W), z, W);
    if (split.status != Status::solved) continue;
    const double size = std::max({std::abs(split.f_x), std::abs(split.g_y), std::abs(split.inner), 1e-3});
    CHECK(std::abs(split.fenchel_gap) <= 1e-9 * size);
  }
}

TEST_CASE("where the rounding of a far point leaves x outside its domain, f(x) is the value at the edge") {
  const auto f = samples::function("sum(kullback_leibler(2), binary_entropy())", 3);
  Matrix gram(3, 3);
  gram << 1, 2, -1, 2, 8, 14, -1, 14, 66;
  const Decomposition split = convex::decompose(f, Vector{{-2e8, 1, 2e8}}, Metric::dense(gram));
  CHECK(split.status == Status::solved);
  // x = (0, 1, 1): 2 + 2 (log(1/2) - 1 + 2)
  CHECK(std::abs(split.f_x - (4 - 2 * std::log(2.0))) <= 1e-9);
}

TEST_CASE("where the rounding of a far point leaves y outside the conjugate's domain, one inside is told") {
  const Question far[] = {
      {"indicator(epigraph(inverse_power(0.5)))", {1e8, 1e8, 0}, {1, 2, -8, 2, 5, -18, -8, -18, 77}},
      {"pointwise_max(pointwise_max(sum_largest(2), huber(2)), dilate(zero(), -2))",
       {-3e8, -2},
       {9, 9, 9, 13}}};
  for (const Question& question : far) {
    CAPTURE(std::string(question.f));
    const auto n = static_cast<convex::Index>(question.z.size());
    const Vector z = Eigen::Map<const Vector>(question.z.data(), n);
    const Metric W = Metric::dense(Eigen::Map<const Matrix>(question.gram.data(), n, n));
    const auto f = samples::function(question.f, W);
    const Decomposition split = convex::decompose(f, z, W);
    CHECK(split.status == Status::solved);
    CHECK(std::isfinite(f.conjugate(W)(split.y.x)));
    CHECK(split.residual <= 1e-14 * W.norm(z));
  }
}

TEST_CASE("the point of a ball nearest to one far away keeps its digits where the center cancels") {
  // center + r d/|d| with d = (1, 3e8 + 2) from the center (0, -1): x_2 = -x_1²/2 to first order.
  const auto ball = samples::function("indicator(ball2(1, [0,-1]))", 2);
  const Vector x = ball.prox(Vector{{1, 3e8 + 1}}, Metric::identity(2)).x;
  CHECK(x[0] == doctest::Approx(1 / (3e8 + 2)).epsilon(1e-15));
  CHECK(x[1] == doctest::Approx(-x[0] * x[0] / 2).epsilon(1e-15));
}

TEST_CASE(
    "the prox of a perspective keeps its digits where W (z - x) is a small difference of large numbers") {
  // x solves W (x - z) + grad f(x) = 0, found in sixty digits.
  const Vector z{{-4065621.848872933, 4e12, 3.75e8}},
      expected{{-3818374.583918947, 3999999998712.2356, 388266965.49357769}};
  const Metric W = Metric::diagonal(Vector{{0.5, 32, 16}});
  const char* const alone = "perspective(quadratic([[36,-12],[-12,4]],[3,-0.418],0.125))";
  const char* const larger =
      "perspective(pointwise_max(linear([1,0.02698376892532197]),quadratic([[36,-12],[-12,4]],[3,-0.418],0."
      "125)))";
  for (const char* const f : {alone, larger}) {
    CAPTURE(std::string(f));
    const convex::Prox found = samples::function(f, 3).prox(z, W);
    CHECK(found.status == Status::solved);
    CHECK(W.norm(found.x - expected) <= 1e-14 * W.norm(z));
    CHECK(W.norm(found.x - expected) <= found.error_bound);
  }
}

TEST_CASE("a domain of one point, which two sets that touch leave, is told as solved for no other point") {
  const Metric W = Metric::diagonal(Vector{{0.03125, 2, 1}});
  const Vector z{{2, -2, -2}};
  const auto f = samples::function(
      "pointwise_max(pointwise_max(separable(distance(polyhedron([[-2,0],[3,-1]], [4,4]), 1), 2, power(3), "
      "1), "
      "indicator(orthant())), conjugate(perspective(power(2))))",
      W);
  const Decomposition split = convex::decompose(f, z, W);
  CHECK((split.status != Status::solved || W.norm(split.x.x) <= split.error_bound));
}
