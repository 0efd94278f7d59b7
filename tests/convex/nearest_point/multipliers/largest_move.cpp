#include "convex/nearest_point/multipliers/largest_move.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::Vector;

namespace {

/// max ||r||_(A⁻¹) over all signs of |r| = balance.
double over_all_corners(const Matrix& A, const Vector& balance) {
  const Metric metric = Metric::dense(A);
  double largest = 0;
  for (int signs = 0; signs < 1 << balance.size(); ++signs) {
    Vector r = balance;
    for (Index i = 0; i < r.size(); ++i)
      if (signs >> i & 1) r[i] = -r[i];
    largest = std::max(largest, metric.dual_norm(r));
  }
  return largest;
}

}  // namespace

TEST_CASE("errors in step with the stiff direction of a metric hide no larger move along a soft one") {
  std::mt19937 draw(1966);
  std::uniform_real_distribution<double> size(0.25, 4);
  for (Index n = 2; n <= 7; ++n)
    for (int round = 0; round < 200; ++round) {
      // Rounding of A q for q along the soft direction of vvᵀ + eps is in step with |v|.
      Vector v(n);
      for (double& entry : v) entry = draw() % 3 == 0 ? 0 : draw() % 2 == 0 ? size(draw) : -size(draw);
      const Matrix A = v * v.transpose() + 0x1p-20 * Matrix::Identity(n, n);
      const Vector balance = v.cwiseAbs();
      if (balance.isZero(0)) continue;
      CAPTURE(v.transpose());
      const double largest = over_all_corners(A, balance);
      CHECK(convex::largest_move(Metric::dense(A), balance) >= 0.7 * largest);
      CHECK(convex::largest_move(Metric::dense(A), balance) <= 1.001 * largest);
      const convex::NearestPointProblem free{
          Metric::dense(A), Vector::Zero(n), convex::ConstraintRows(convex::RowMatrix(0, n)), Vector(0), {}};
      CHECK(convex::largest_move(free, {}, balance, Vector(0)).of_point >= 0.7 * largest);
      CHECK(convex::largest_move(free, {}, balance, Vector(0)).of_point <= 1.001 * largest);
    }
}

TEST_CASE(
    "rows nearly parallel to others move the point as far as they amplify what is missed, however far") {
  for (const double angle : {1e-2, 1e-4, 1e-6}) {
    CAPTURE(angle);
    convex::RowMatrix U(3, 3);
    U << 1, 0, 0, 1, angle, 0, 1, 1, angle;
    const convex::NearestPointProblem held{
        Metric::identity(3), Vector::Zero(3), convex::ConstraintRows(U), Vector::Zero(3), {0, 1, 2}};
    double largest = 0;
    for (int signs = 0; signs < 8; ++signs) {
      const double r1 = signs & 1 ? -1 : 1, r2 = signs & 2 ? -1 : 1, r3 = signs & 4 ? -1 : 1;
      const double x = r1, y = (r2 - x) / angle, z = (r3 - x - y) / angle;
      largest = std::max(largest, std::sqrt(x * x + y * y + z * z));
    }
    const double found = convex::largest_move(held, {0, 1, 2}, Vector::Zero(3), Vector::Ones(3)).of_point;
    CHECK(found >= 0.7 * largest);
    CHECK(found <= 1.001 * largest);
  }
}
