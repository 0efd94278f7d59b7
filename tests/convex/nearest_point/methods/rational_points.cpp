#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>

#include "convex/nearest_point/methods.hpp"

using convex::Index;
using convex::Matrix;
using convex::MethodKind;
using convex::NearestPointProblem;
using convex::Solution;
using convex::SparseMatrix;
using convex::Status;
using convex::Vector;

namespace {

/// A problem of whole numbers whose solution is k / d, k whole: the point is no double, but of every row it
/// is known whether it is touched.
struct RationalPoint {
  NearestPointProblem problem;
  std::vector<bool> is_touched;
};

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  int between(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
  }

  RationalPoint point(Index n, Index m, bool is_diagonal) {
    constexpr int denominators[] = {3, 5, 7, 10, 49};
    const int d = denominators[between(0, 4)];
    Matrix B = Matrix::Zero(n, n);
    for (double& entry : B.reshaped())
      if (!is_diagonal) entry = between(-2, 2);
    Matrix A = B * B.transpose();
    for (double& entry : A.diagonal()) entry += between(1, 4);
    Vector k(n), s(m), lambda = Vector::Zero(m);
    for (double& entry : k) entry = between(0, 1) == 1 ? between(-2 * d, 2 * d) : d * between(-2, 2);
    convex::RowMatrix U(m, n);
    std::vector<bool> is_touched;
    for (Index a = 0; a < m; ++a) {
      for (int tries = 0; tries < 40; ++tries) {
        for (double& entry : U.row(a)) entry = between(0, 1) == 1 ? between(-2, 2) : 0;
        if (std::fmod(U.row(a).dot(k), d) == 0) break;
      }
      const double height = U.row(a).dot(k);
      is_touched.push_back(std::fmod(height, d) == 0 && between(0, 5) > 0);
      s[a] = is_touched.back() ? height / d : std::floor(height / d) - 1;
      if (is_touched.back() && between(0, 2) == 0) lambda[a] = between(1, 9);
    }
    const Vector z = A * k - U.transpose() * lambda;
    A *= d;
    return {{is_diagonal ? convex::Metric::diagonal(A.diagonal()) : convex::Metric::dense(A),
             z,
             convex::ConstraintRows(U),
             s,
             {}},
            is_touched};
  }

 private:
  std::mt19937 random_;
};

}  // namespace

TEST_CASE("a slack of 0 is told as 0, and no other, where the point itself is no double") {
  for (unsigned seed = 0; seed < 400; ++seed) {
    Draw draw(seed);
    const Index n = draw.between(2, 6), m = draw.between(1, static_cast<int>(2 * n));
    const auto [problem, is_touched] = draw.point(n, m, seed % 3 == 0);
    for (const convex::Method& method : convex::methods()) {
      if (method.kind == MethodKind::for_comparison || !method.applies(problem).empty()) continue;
      CAPTURE(seed);
      CAPTURE(std::string(method.name));
      const Solution found = method.solve(problem, {});
      if (found.status != Status::solved) continue;
      for (Index a = 0; a < m; ++a) {
        CAPTURE(a);
        CHECK((found.slack[a] == 0) == is_touched[convex::at(a)]);
      }
    }
    CHECK(convex::methods().front().solve(problem, {}).status == Status::solved);
  }
}
