#include "convex/nearest_point/proof/enclosure.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "tests/oracles/full_mantissa.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_kkt.hpp"

using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Vector;
using oracles::Difficulty;

namespace {

/// ||q - q*||_A by elimination in fractions, rounded at the end.
double true_error(const NearestPointProblem& problem, const Solution& solution) {
  const oracles::RationalPoint exact = oracles::solve_kkt(problem, solution.basis);
  REQUIRE(oracles::is_exact_solution(problem, exact));
  return oracles::relative_error(problem, solution.q, exact, 1.0);
}

/// What the truth itself may be off by, rounded from fractions.
constexpr double rounded_up = 1 + 0x1p-50;

void check_bound(const NearestPointProblem& problem, const Solution& solution) {
  const auto bound = convex::enclosed_error(problem, solution);
  REQUIRE(bound);
  const double truth = true_error(problem, solution), ulp = 0x1p-52 * problem.A.norm(solution.q);
  CHECK(*bound * rounded_up >= truth);
  CHECK(*bound <= std::max(100 * truth, 4 * ulp));
}

/// A and the rows of a strictly feasible problem, changed.
NearestPointProblem with_metric(NearestPointProblem problem, const Matrix& A) {
  problem.A = convex::Metric::dense(A);
  return problem;
}

}  // namespace

TEST_CASE("where signs are strict the bound is above the true error and near it") {
  for (unsigned seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    const Index n = 1 + static_cast<Index>(seed % 9), m = static_cast<Index>((7 * seed) % 13);
    const NearestPointProblem problem = oracles::full_mantissa(seed, n, m);
    check_bound(problem, convex::active_set(problem));
    NearestPointProblem diagonal = problem;
    diagonal.A = convex::Metric::diagonal(problem.A.diagonal());
    check_bound(diagonal, convex::active_set(diagonal));
    NearestPointProblem sparse = problem;
    sparse.A = convex::Metric::sparse(problem.A.dense_gram().sparseView());
    check_bound(sparse, convex::active_set(sparse));
    if (m == 0) continue;
    NearestPointProblem two_sided = problem;
    two_sided.two_sided = {0};
    const Solution solution = convex::active_set(two_sided);
    if (solution.farkas.size() == 0) check_bound(two_sided, solution);
  }
}

TEST_CASE("the bound holds for ill-conditioned inertia and for rows at a small angle") {
  for (const double small : {1e-2, 1e-5, 1e-8}) {
    CAPTURE(small);
    for (unsigned seed = 0; seed < 5; ++seed) {
      const NearestPointProblem problem = oracles::full_mantissa(seed, 5, 8);
      const Vector v = Vector::LinSpaced(5, 0.3, 1.1);
      const NearestPointProblem stiff =
          with_metric(problem, v * v.transpose() + small * Matrix(Vector::LinSpaced(5, 1, 2).asDiagonal()));
      check_bound(stiff, convex::active_set(stiff));
    }
    // Two rows at the angle `small`, both held.
    const NearestPointProblem wedge{convex::Metric::dense(Matrix{{2, 0.3}, {0.3, 1.1}}),
                                    Vector{{-1.0, -9.0}},
                                    convex::ConstraintRows(RowMatrix{{small, 1.01}, {-small, 1.02}}),
                                    Vector{{0.11, 0.12}},
                                    {}};
    check_bound(wedge, convex::active_set(wedge));
  }
}

TEST_CASE("the bound follows an answer that is made worse") {
  const NearestPointProblem problem = oracles::full_mantissa(4, 6, 9);
  for (const double shift : {1e-14, 1e-9, 1e-4}) {
    Solution solution = convex::active_set(problem);
    solution.q[2] += shift;
    const auto bound = convex::enclosed_error(problem, solution);
    REQUIRE(bound);
    const double truth = true_error(problem, solution);
    CHECK(*bound * rounded_up >= truth);
    CHECK(*bound <= 1.001 * truth);
  }
}

TEST_CASE("the answer for a wrong set of rows is never proved to be the right one") {
  int wrong_answers = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = oracles::full_mantissa(seed, 5, 9);
    const Solution solution = convex::active_set(problem);
    const oracles::RationalPoint exact = oracles::solve_kkt(problem, solution.basis);
    REQUIRE(oracles::is_exact_solution(problem, exact));
    const auto check = [&](const std::vector<Index>& basis) {
      // The point of these rows, as if it were the answer.
      const oracles::RationalPoint point = oracles::solve_kkt(problem, basis);
      Solution wrong = solution;
      wrong.basis = basis;
      for (Index i = 0; i < 5; ++i) wrong.q[i] = point.q[static_cast<std::size_t>(i)].get_d();
      for (Index a = 0; a < 9; ++a) wrong.lambda[a] = point.lambda[static_cast<std::size_t>(a)].get_d();
      const double off = oracles::relative_error(problem, wrong.q, exact, 1.0);
      if (off > 1e-9) ++wrong_answers;
      const auto bound = convex::enclosed_error(problem, wrong);
      if (bound) CHECK(*bound * rounded_up >= off);
    };
    for (std::size_t k = 0; k < solution.basis.size(); ++k) {
      std::vector<Index> fewer = solution.basis;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      check(fewer);
    }
    for (Index a = 0; a < 9 && solution.basis.size() < 5; ++a) {
      std::vector<Index> more = solution.basis;
      if (std::count(more.begin(), more.end(), a) > 0) continue;
      more.push_back(a);
      check(more);
    }
  }
  CHECK(wrong_answers > 100);
}

TEST_CASE("where a sign is not strict, or rows depend on each other, the bound holds if there is one") {
  Index weak = 0, proved = 0;
  for (unsigned seed = 0; seed < 60; ++seed)
    for (const Difficulty difficulty :
         {Difficulty::none, Difficulty::repeated_rows, Difficulty::two_sided_rows, Difficulty::at_rest}) {
      const auto [problem, x] = oracles::planted_problem(seed, 4, 7, difficulty);
      const Solution solution = convex::active_set(problem);
      bool strict = true;
      for (Index a = 0; a < 7; ++a) {
        const bool held = std::count(solution.basis.begin(), solution.basis.end(), a) > 0;
        const bool two_sided = std::count(problem.two_sided.begin(), problem.two_sided.end(), a) > 0;
        const double slack = problem.U.row(a).dot(x) - problem.s[a];  // integers: exact
        const oracles::RationalPoint exact = oracles::solve_kkt(problem, solution.basis);
        if (held && !two_sided && exact.lambda[static_cast<std::size_t>(a)] == 0) strict = false;
        if (!held && slack == 0) strict = false;
      }
      weak += strict ? 0 : 1;
      const auto bound = convex::enclosed_error(problem, solution);
      CHECK((bound || !strict));
      if (!bound) continue;
      proved += strict ? 0 : 1;
      CHECK(*bound * rounded_up >= problem.A.norm(solution.q - x));
    }
  CHECK(weak > 50);
  CHECK(proved > 50);
}

TEST_CASE("a compensated sum is within its own bound, whatever cancels") {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    convex::CompensatedSum sum;
    oracles::Rational exact = 0;
    const auto add = [&](double x, double y) {
      sum.add(x, y);
      exact += oracles::Rational(x) * oracles::Rational(y);
    };
    double rest = 0;
    for (int i = 0; i < 30; ++i) {
      const double x = std::ldexp(normal(generator), (7 * i) % 90), y = normal(generator);
      add(x, y);
      rest += x * y;
    }
    add(-rest, 1);
    const oracles::Rational off = abs(oracles::Rational(sum.result().value) - exact);
    CHECK((off <= oracles::Rational(sum.result().radius)));
  }
}
