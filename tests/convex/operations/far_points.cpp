#include <doctest/doctest.h>

#include "convex/functions/decomposition.hpp"
#include "tests/convex/operations/samples.hpp"

/// Points far above what is left of them, in metrics that couple their entries: doubles of the larger part
/// carry no digit of the smaller one.
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
    {"envelope(perspective(quadratic([[9,-9,6],[-9,9,-6],[6,-6,4]], [2,-1,3])), 1)", {2, 3, -2, -1}, {}},
};

}  // namespace

TEST_CASE("a split of a point far above its parts is solved, and its values agree") {
  for (const Question& question : questions) {
    CAPTURE(question.f);
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
    CAPTURE(question.f);
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
