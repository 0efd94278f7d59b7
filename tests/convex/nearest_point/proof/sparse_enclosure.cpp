#include "convex/nearest_point/proof/sparse_enclosure.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/proof/enclosure.hpp"
#include "tests/oracles/rational_kkt.hpp"

using convex::Index;
using convex::NearestPointProblem;
using convex::Solution;
using convex::SparseMatrix;
using convex::Vector;

namespace {

SparseMatrix second_differences(Index n) {
  SparseMatrix M(n, n);
  for (Index i = 0; i < n; ++i) {
    M.insert(i, i) = 2;
    if (i > 0) M.insert(i - 1, i) = M.insert(i, i - 1) = -1;
  }
  return M;
}

/// A string of n beads above a floor, pulled down in its middle third.
NearestPointProblem string_on_floor(Index n) {
  convex::SparseRows U(n, n);
  U.setIdentity();
  Vector z = Vector::Constant(n, 0.3);
  z.segment(n / 3, n / 3).setConstant(-1.7);
  return {convex::Metric::sparse(second_differences(n)),
          z,
          convex::ConstraintRows(U),
          Vector::Constant(n, -0.1),
          {}};
}

}  // namespace

TEST_CASE(
    "the least eigenvalue of second differences, 2 - 2 cos(pi/(n+1)), is bounded from below and closely") {
  for (const Index n : {1, 5, 40, 400}) {
    const double exact = 4 * std::pow(std::sin(std::acos(-1.0) / (2 * static_cast<double>(n + 1))), 2);
    const auto found = convex::least_eigenvalue_below(second_differences(n), 0);
    REQUIRE(found);
    CHECK(*found < exact);
    CHECK(*found >= 0.3 * exact);
    CHECK_FALSE(convex::least_eigenvalue_below(second_differences(n), exact));
  }
  SparseMatrix singular = second_differences(6);
  singular.coeffRef(0, 0) = singular.coeffRef(5, 5) = 1;
  CHECK_FALSE(convex::least_eigenvalue_below(singular, 0));
}

TEST_CASE("the bound from sparse factors is above the true error, of good answers and of spoilt ones") {
  const NearestPointProblem problem = string_on_floor(24);
  Solution solution = convex::active_set(problem);
  REQUIRE(solution.basis.size() > 3);
  const oracles::RationalPoint exact = oracles::solve_kkt(problem, solution.basis);
  REQUIRE(oracles::is_exact_solution(problem, exact));
  for (const double spoilt : {0.0, 1e-14, 1e-10, 1e-7}) {
    Solution answer = solution;
    answer.q[11] += spoilt;
    answer.q[3] -= spoilt / 3;
    const auto bound = convex::sparse_enclosed_error(problem, convex::RadiiOf(nullptr), answer, answer.basis);
    REQUIRE(bound);
    CHECK(oracles::relative_error(problem, answer.q, exact, 1) <= *bound);
    CHECK(*bound <= 1e3 * spoilt + 1e-12);
  }
}

TEST_CASE("a set of rows with one left out, one too many or one twice is not proved") {
  const NearestPointProblem problem = string_on_floor(24);
  const Solution solution = convex::active_set(problem);
  std::vector<Index> rows = solution.basis;
  rows.pop_back();
  CHECK_FALSE(convex::sparse_enclosed_error(problem, convex::RadiiOf(nullptr), solution, rows));
  rows = solution.basis;
  rows.push_back(0);
  CHECK_FALSE(convex::sparse_enclosed_error(problem, convex::RadiiOf(nullptr), solution, rows));
  rows = solution.basis;
  rows.push_back(rows.front());
  CHECK_FALSE(convex::sparse_enclosed_error(problem, convex::RadiiOf(nullptr), solution, rows));
}

TEST_CASE("thousands of coordinates are proved with sparse factors") {
  const NearestPointProblem string = string_on_floor(2000);
  const auto bound = convex::enclosed_error(string, convex::automatic(string, {}));
  REQUIRE(bound);
  CHECK(*bound > 0);
  const auto chain = convex::gallery_instance(*convex::find_family("chain"), 2000, 100);
  const Solution solution = convex::automatic(chain.problem, {});
  const auto of_chain = convex::enclosed_error(chain.problem, solution);
  REQUIRE(of_chain);
  CHECK(chain.problem.A.norm(solution.q - chain.solution.hi - chain.solution.lo) <= *of_chain);
}

TEST_CASE("a point that doubles hold is proved however its rows depend on each other, dense or sparse") {
  for (const Index n : {60, 2000}) {
    // Beads on a floor and on each other, every row written thrice, and the whole between two walls.
    std::vector<Eigen::Triplet<double>> entries;
    Index m = 0;
    for (int times = 0; times < 3; ++times)
      for (Index i = 0; i < n; ++i, ++m) {
        entries.emplace_back(m, i, times + 1);
        if (i > 0) entries.emplace_back(m, i - 1, -times - 1);
      }
    for (Index i = 0; i < n; i += 2, ++m) entries.emplace_back(m, i, -1);
    convex::SparseRows U(m, n);
    U.setFromTriplets(entries.begin(), entries.end());
    const NearestPointProblem problem{convex::Metric::sparse(second_differences(n)),
                                      Vector::LinSpaced(n, -1, -3),
                                      convex::ConstraintRows(U),
                                      Vector::Zero(m),
                                      {}};
    const Solution solution = convex::automatic(problem, {});
    CHECK(solution.q.isZero(0));  // every gap is 0
    const auto bound = convex::enclosed_error(problem, solution);
    REQUIRE(bound);
    CHECK(*bound <= 1e-12 * problem.A.dual_norm(problem.z));
    Solution spoilt = solution;
    spoilt.q[n / 2] += 1e-3;
    const auto of_spoilt = convex::enclosed_error(problem, spoilt);
    CHECK((!of_spoilt || *of_spoilt >= problem.A.norm(spoilt.q)));
    spoilt = solution;
    spoilt.lambda[0] = -1;
    CHECK_FALSE(convex::sparse_kept_error(problem, convex::RadiiOf(nullptr), spoilt));
  }
}

TEST_CASE("the bound from sparse factors holds for every problem within radii") {
  const NearestPointProblem problem = string_on_floor(18);
  const Solution solution = convex::active_set(problem);
  const Index n = problem.dimension();
  constexpr double radius = 0x1p-34;
  convex::EntryRadii radii{problem.A.sparse_gram(), Vector::Constant(n, radius), problem.U.sparse(),
                           Vector::Constant(n, radius)};
  radii.A.coeffs().setConstant(radius);
  radii.U.coeffs().setConstant(radius);
  const auto bound =
      convex::sparse_enclosed_error(problem, convex::RadiiOf(&radii), solution, solution.basis);
  REQUIRE(bound);
  for (const double side : {radius, -radius})
    for (const bool alternates : {false, true}) {
      NearestPointProblem moved = problem;
      SparseMatrix A = problem.A.sparse_gram();
      A.diagonal().array() += side;
      moved.A = convex::Metric::sparse(A);
      convex::SparseRows U = problem.U.sparse();
      U.coeffs().array() -= side;
      moved.U = convex::ConstraintRows(U);
      for (Index i = 0; i < n; ++i) {
        moved.z[i] += alternates && i % 2 == 1 ? -side : side;
        moved.s[i] += side;
      }
      const Solution other = convex::active_set(moved);
      const oracles::RationalPoint exact = oracles::solve_kkt(moved, other.basis);
      REQUIRE(oracles::is_exact_solution(moved, exact));
      const double off = oracles::relative_error(moved, solution.q, exact, 1);
      CHECK(off <= *bound);
      CHECK(off > 1e-2 * radius);
    }
}
