#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"

using namespace convex;

namespace {

/// Minimises stiff/2 ||x||² - z·x + sum |a_j·x - b_j| in the form w_j >= 0, w_j >= a_j·x - b_j, the w held by
/// so small a curvature that the interior-point start does not see which rows are active.
NearestPointProblem absolute_deviations(Index n, Index m, double stiff, double soft, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Vector curvature(n + m), z(n + m), s = Vector::Zero(2 * m);
  curvature << Vector::Constant(n, stiff), Vector::Constant(m, soft);
  z << Vector::Zero(n), Vector::Constant(m, -2);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index j = 0; j < m; ++j) {
    s[2 * j + 1] = -normal(generator);
    entries.emplace_back(2 * j, n + j, 1);
    entries.emplace_back(2 * j + 1, n + j, 1);
    for (Index i = 0; i < n; ++i) {
      const double a = normal(generator);
      z[i] += a;
      entries.emplace_back(2 * j + 1, i, -a);
    }
  }
  SparseRows U(2 * m, n + m);
  U.setFromTriplets(entries.begin(), entries.end());
  return {Metric::diagonal(curvature), z, ConstraintRows(U), s, {}};
}

}  // namespace

TEST_CASE("the rows at which the sparse method gives up are where the dense one begins") {
  const NearestPointProblem problem = absolute_deviations(25, 400, 2e-2, 1e-7, 1);
  const Solution left = sparse_active_set(problem, {.limit = 0});
  REQUIRE(left.status == Status::gave_up);
  CHECK(!left.basis.empty());
  const Solution whole = active_set(problem), found = automatic(problem, {.reduce = false});
  REQUIRE(whole.status == Status::solved);
  REQUIRE(found.status == Status::solved);
  CHECK(problem.A.norm(found.q - whole.q) <= 1e-14 * problem.A.norm(whole.q));
  CHECK(2 * found.steps < whole.steps);
}
