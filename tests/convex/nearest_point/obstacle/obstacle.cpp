#include "convex/nearest_point/obstacle/obstacle.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "convex/nearest_point/optimality/residuals.hpp"

using convex::Index;
using convex::Metric;
using convex::NearestPointProblem;
using convex::Solution;
using convex::SparseMatrix;
using convex::SparseRows;
using convex::Status;
using convex::Vector;

namespace {

/// d on the diagonal, -c beside it, on width×height points; rows u q >= s with u a power of 2, some of them
/// equations, on four points of five.
NearestPointProblem membrane(Index width, Index height, double d, double c, std::mt19937& draw) {
  std::vector<Eigen::Triplet<double>> A, U;
  std::normal_distribution<double> normal;
  std::vector<double> s;
  std::vector<Index> two_sided;
  Vector z(width * height);
  for (Index j = 0; j < height; ++j)
    for (Index i = 0; i < width; ++i) {
      const int k = static_cast<int>(j * width + i), row = static_cast<int>(s.size());
      A.emplace_back(k, k, d);
      if (i > 0) A.emplace_back(k, k - 1, -c), A.emplace_back(k - 1, k, -c);
      if (j > 0) A.emplace_back(k, k - width, -c), A.emplace_back(k - width, k, -c);
      z[k] = normal(draw) - 0.2;
      if (k % 5 == 4) continue;
      const double u = std::ldexp(1.0, k % 3 - 1);
      U.emplace_back(row, k, u);
      if (k % 31 == 7) two_sided.push_back(row);
      s.push_back(u * 0.25 * std::round(normal(draw)));
    }
  SparseMatrix W(z.size(), z.size());
  W.setFromTriplets(A.begin(), A.end());
  SparseRows rows(static_cast<Index>(s.size()), z.size());
  rows.setFromTriplets(U.begin(), U.end());
  return {Metric::sparse(W), z, convex::ConstraintRows(rows),
          Eigen::Map<const Vector>(s.data(), static_cast<Index>(s.size())), two_sided};
}

}  // namespace

TEST_CASE("an obstacle's answer meets the conditions of optimality in long doubles") {
  using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  std::mt19937 draw(1966);
  for (const auto& [width, height] : {std::pair<Index, Index>{8, 8}, {9, 40}, {33, 20}, {64, 64}}) {
    const NearestPointProblem problem = membrane(width, height, 4.5, 1, draw);
    const std::optional<Solution> found = convex::solve_obstacle(problem);
    REQUIRE(found.has_value());
    CHECK(found->status == Status::solved);
    const LongVector q = found->q.cast<long double>(), lambda = found->lambda.cast<long double>();
    const LongVector balance = problem.A.sparse_gram().cast<long double>() * q -
                               problem.z.cast<long double>() -
                               problem.U.sparse().cast<long double>().transpose() * lambda;
    const LongVector slack = problem.U.sparse().cast<long double>() * q - problem.s.cast<long double>();
    CHECK(balance.cwiseAbs().maxCoeff() <= 1e-14L);
    CHECK(slack.minCoeff() >= -1e-15L);
    CHECK(std::abs(slack.dot(lambda)) <= 1e-13L);
    for (Index a : problem.two_sided) CHECK(slack[a] == 0);
    for (Index a = 0, next = 0; a < problem.rows(); ++a) {
      const bool is_two_sided =
          next < static_cast<Index>(problem.two_sided.size()) && problem.two_sided[convex::at(next)] == a;
      next += is_two_sided;
      if (!is_two_sided) CHECK(lambda[a] >= 0);
    }
  }
}

TEST_CASE("what an obstacle's answer says of itself by its grid is what the entries of A say") {
  std::mt19937 draw(1963);
  for (const auto& [width, height] : {std::pair<Index, Index>{8, 17}, {30, 12}, {40, 40}}) {
    const NearestPointProblem problem = membrane(width, height, 5, 1.25, draw);
    const std::optional<Solution> found = convex::solve_obstacle(problem);
    REQUIRE(found.has_value());
    CHECK(found->acceleration_norm == doctest::Approx(problem.A.norm(found->q)).epsilon(1e-14));
    CHECK(found->force_norm == doctest::Approx(problem.A.dual_norm(problem.z)).epsilon(1e-7));
    const convex::Residuals own = found->residuals,
                            other = convex::residuals(problem, found->q, found->lambda);
    CHECK(other.stationarity > 0);
    CHECK(own.stationarity == doctest::Approx(other.stationarity).epsilon(0.02));
    CHECK(own.duality_gap == doctest::Approx(other.duality_gap).epsilon(0.02));
    CHECK(own.feasibility == other.feasibility);
  }
}

TEST_CASE("a matrix that is one entry off a grid's is no obstacle problem") {
  std::mt19937 draw(1962);
  const NearestPointProblem problem = membrane(12, 9, 4, 1, draw);
  SparseMatrix W = problem.A.sparse_gram();
  W.coeffRef(40, 40) = std::nextafter(4.0, 5.0);
  CHECK(convex::solve_obstacle(problem).has_value());
  CHECK_FALSE(convex::solve_obstacle({Metric::sparse(W), problem.z, problem.U, problem.s, problem.two_sided})
                  .has_value());
}
