#include "convex/nearest_point/multipliers/exact_multipliers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "convex/infinity.hpp"
#include "convex/linear_algebra/cholesky.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/multipliers/multipliers.hpp"
#include "convex/nearest_point/proof/decided_in_fractions.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::ExactMultipliers;
using convex::ExactProblem;
using convex::ExactSolution;
using convex::Index;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Vector;
using oracles::Difficulty;
using oracles::Rational;
using oracles::RationalVector;

namespace {

/// A table on four legs: lambda = mg/4 + t (1, -1, 1, -1), |t| <= mg/4.
NearestPointProblem four_legs() {
  return {convex::Metric::diagonal(Vector{{10.0, 4.0, 4.0}}),
          Vector{{-100.0, 0.0, 0.0}},
          convex::ConstraintRows(RowMatrix{{1, 1, 1}, {1, 1, -1}, {1, -1, -1}, {1, -1, 1}}),
          Vector::Zero(4),
          {}};
}

std::string shown(const std::optional<convex::Fraction>& end) { return end ? convex::text(*end) : "inf"; }

}  // namespace

TEST_CASE("the load of a table on four legs is shared by a quarter each, or anything up to a half") {
  const ExactProblem problem = convex::exact_problem(four_legs());
  const ExactMultipliers all =
      convex::exact_multipliers(problem, convex::exact_active_set(problem, {}), true);
  CHECK_FALSE(all.unique);
  CHECK(all.tight == std::vector<Index>{0, 1, 2, 3});
  REQUIRE(all.ranges);
  for (std::size_t a = 0; a < 4; ++a) {
    CHECK(convex::text(convex::entry(all.least_norm, a)) == "25");
    CHECK(shown((*all.ranges)[a].low) == "0");
    CHECK(shown((*all.ranges)[a].high) == "50");
  }
}

TEST_CASE(
    "multipliers have a least norm where the squares of the ratios of rows leave the range of doubles") {
  // Of x >= 0 in three units: lambda = -1 in all, as much as may be by the longest row.
  const NearestPointProblem problem{convex::Metric::identity(1),
                                    Vector::Constant(1, -1),
                                    convex::ConstraintRows(RowMatrix{{1e-322}, {2.5e-321}, {25.5}}),
                                    Vector::Zero(3),
                                    {}};
  const ExactProblem exact = convex::exact_problem(problem);
  const ExactMultipliers all = convex::exact_multipliers(exact, convex::exact_active_set(exact, {}), true);
  CHECK(oracles::is_exact_solution(problem, {{Rational(0)}, oracles::rationals(all.least_norm)}));
  CHECK(convex::nearest_double(convex::entry(all.least_norm, 2)) == 1 / 25.5);
}

TEST_CASE(
    "the least norm is shared in proportion to the rows where those that press do not span the others") {
  // r = (1, 0) and nothing in the second coordinate, where two rows face each other.
  const NearestPointProblem problem{
      convex::Metric::identity(2),
      Vector{{-1.0, 0.0}},
      convex::ConstraintRows(RowMatrix{{3, 0}, {3, 0}, {6, 0}, {0, 1}, {0, -1}}),
      Vector::Zero(5),
      {}};
  const ExactProblem exact = convex::exact_problem(problem);
  const ExactMultipliers all = convex::exact_multipliers(exact, convex::exact_active_set(exact, {}), true);
  const std::vector<std::string> shares{"1/18", "1/18", "1/9", "0", "0"};
  for (std::size_t a = 0; a < shares.size(); ++a)
    CHECK(convex::text(convex::entry(all.least_norm, a)) == shares[a]);
}

TEST_CASE("the least norm has multipliers that doubles do not see beside the others") {
  // lambda = (1 - e t, t, t) is shortest at t = e / (2 + e²).
  for (const double e : {0x1p-60, 0x1p-300}) {
    CAPTURE(e);
    const NearestPointProblem problem{convex::Metric::identity(2),
                                      Vector{{-1.0, 0.0}},
                                      convex::ConstraintRows(RowMatrix{{1, 0}, {e, 1}, {0, -1}}),
                                      Vector::Zero(3),
                                      {}};
    const ExactProblem exact = convex::exact_problem(problem);
    const ExactMultipliers all = convex::exact_multipliers(exact, convex::exact_active_set(exact, {}), true);
    const Rational t = Rational(e) / (2 + Rational(e) * Rational(e));
    const RationalVector least = oracles::rationals(all.least_norm);
    CHECK((least[0] == 1 - Rational(e) * t));
    CHECK((least[1] == t));
    CHECK((least[2] == t));
  }
}

TEST_CASE(
    "a multiplier that turns out negative is 0: doubles cannot say which where numbers are beyond them") {
  const auto row = [](const char* first, const char* second) {
    return convex::exact_vector(
        std::vector<convex::Fraction>{*convex::read_fraction(first), *convex::read_fraction(second)});
  };
  // r = (1, 0). With all rows of the first problem two multipliers would be negative, and the others span;
  // with those of the second two would be, and the other does not span.
  const std::vector<convex::ExactRows> problems{
      {row("1", "0"), row("0", "1"), row("0", "-1"), row("-1", "-1e400")},
      {row("1", "0"), row("-1", "1e400"), row("0", "-1")}};
  for (const convex::ExactRows& rows : problems) {
    const ExactProblem problem =
        convex::exact_problem({row("1", "0"), row("0", "1")}, row("-1", "0"), rows,
                              convex::exact_vector(std::vector<convex::Fraction>(rows.size())), {});
    const ExactMultipliers all =
        convex::exact_multipliers(problem, convex::exact_active_set(problem, {}), true);
    for (std::size_t a = 0; a < rows.size(); ++a)
      CHECK(convex::text(convex::entry(all.least_norm, a)) == (a == 0 ? "1" : "0"));
  }
}

TEST_CASE("two-sided rows that repeat each other have multipliers of any size") {
  NearestPointProblem problem = four_legs();
  problem.two_sided = {0, 1, 2, 3};
  const ExactProblem exact = convex::exact_problem(problem);
  const ExactMultipliers all = convex::exact_multipliers(exact, convex::exact_active_set(exact, {}), true);
  CHECK_FALSE(all.unique);
  for (const convex::ExactInterval& range : *all.ranges) {
    CHECK_FALSE(range.low);
    CHECK_FALSE(range.high);
  }
  CHECK(convex::text(convex::entry(all.least_norm, 2)) == "25");
}

TEST_CASE("least-norm multipliers give the same reaction and lie, with the vertex found, in their ranges") {
  for (const Difficulty difficulty : {Difficulty::repeated_rows, Difficulty::sums_of_rows,
                                      Difficulty::two_sided_rows, Difficulty::opposite_rows})
    for (unsigned seed = 0; seed < 12; ++seed) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const NearestPointProblem problem = oracles::planted_problem(seed, 4, 12, difficulty).problem;
      const ExactProblem exact = convex::exact_problem(problem);
      const ExactSolution solution = convex::exact_active_set(exact, {});
      const ExactMultipliers all = convex::exact_multipliers(exact, solution, true);
      const RationalVector q = oracles::rationals(solution.q), vertex = oracles::rationals(solution.lambda),
                           least = oracles::rationals(all.least_norm);
      CHECK(oracles::is_exact_solution(problem, {q, least}));
      Rational norm = 0, vertex_norm = 0, product = 0;
      for (std::size_t a = 0; a < least.size(); ++a) {
        norm += least[a] * least[a];
        vertex_norm += vertex[a] * vertex[a];
        product += least[a] * vertex[a];
        const convex::ExactInterval& range = (*all.ranges)[a];
        for (const Rational& value : {least[a], vertex[a]}) {
          CHECK((!range.low || oracles::rational(*range.low) <= value));
          CHECK((!range.high || oracles::rational(*range.high) >= value));
        }
      }
      // The nearest point of a convex set to 0: least·(other - least) >= 0.
      CHECK((product >= norm));
      CHECK(all.unique == (norm == vertex_norm && all.ranges &&
                           std::all_of(all.ranges->begin(), all.ranges->end(), [](const auto& range) {
                             return range.low && range.high && *range.low == *range.high;
                           })));
      // Doubles, in the multipliers of the dependent rows, agree.
      const auto rounded = convex::multipliers(problem, convex::active_set(problem), 1e-9, true);
      CHECK(rounded.unique == all.unique);
      CHECK((rounded.least_norm - convex::nearest(all.least_norm)).norm() <=
            1e-9 * rounded.least_norm.norm());
      for (std::size_t a = 0; a < least.size(); ++a) {
        const convex::Interval range = (*rounded.ranges)[a];
        const auto& exact_range = (*all.ranges)[a];
        CHECK(std::isinf(range.high) == !exact_range.high);
        if (exact_range.high)
          CHECK(range.high == doctest::Approx(convex::nearest_double(*exact_range.high)).epsilon(1e-9));
        if (exact_range.low)
          CHECK(range.low == doctest::Approx(convex::nearest_double(*exact_range.low)).epsilon(1e-9));
      }
    }
}

namespace {

/// 0 is the nearest point to 0, and every row touches it: as many dependences as there are rows beyond n.
NearestPointProblem many_rows_at_a_vertex(Index n, Index m) {
  RowMatrix U(m, n);
  for (Index a = 0; a < m; ++a)
    for (Index i = 0; i < n; ++i)
      U(a, i) = static_cast<double>((7 * a * a + 11 * a * i + 5 * i * i) % 13 - 4);
  return {convex::Metric::diagonal(Vector::Ones(n)),
          -Vector(U.colwise().sum().transpose()),
          convex::ConstraintRows(U),
          Vector::Zero(m),
          {}};
}

}  // namespace

TEST_CASE("multipliers of many dependent rows are left out where fractions would take too long for them") {
  const NearestPointProblem problem = many_rows_at_a_vertex(6, 1200);
  const convex::ExactProblem exact = convex::exact_problem(problem);
  const convex::ExactSolution solution = convex::exact_active_set(exact, {});
  REQUIRE(solution.status == convex::Status::solved);
  CHECK_FALSE(convex::exact_multipliers(exact, solution, true, convex::most_word_operations));
  CHECK_FALSE(convex::exact_multipliers(exact, solution, false, 1e4));
}

TEST_CASE("of 1200 rows at a vertex the least norm is found: six numbers tell it") {
  const NearestPointProblem problem = many_rows_at_a_vertex(6, 1200);
  const convex::ExactProblem exact = convex::exact_problem(problem);
  const convex::ExactSolution solution = convex::exact_active_set(exact, {});
  const auto all = convex::exact_multipliers(exact, solution, false, convex::most_word_operations);
  REQUIRE(all);
  const RationalVector least = oracles::rationals(all->least_norm);
  CHECK(oracles::is_exact_solution(problem, {oracles::rationals(solution.q), least}));
  // lambda = (U w)+: w from the loaded rows, that of least squares in doubles.
  const Vector lambda = convex::nearest(all->least_norm);
  std::vector<Index> loaded;
  for (Index a = 0; a < lambda.size(); ++a)
    if (lambda[a] > 0) loaded.push_back(a);
  const convex::Matrix U = problem.U.dense(), of_loaded = U(loaded, Eigen::all);
  const convex::linear_algebra::Cholesky gram(of_loaded.transpose() * of_loaded);
  const Vector w = gram.solve(of_loaded.transpose() * lambda(loaded));
  CHECK(((U * w).cwiseMax(0) - lambda).norm() <= 1e-10 * lambda.norm());
}

TEST_CASE("where multipliers take too long the exact point alone still bounds the error") {
  const NearestPointProblem problem = many_rows_at_a_vertex(6, 1200);
  const convex::ExactProblem exact = convex::exact_problem(problem);
  convex::Solution near;
  near.q = Vector::Constant(6, 1e-9);
  const double off = problem.A.norm(near.q);
  const double bound = convex::bound_proved_in_fractions(exact, near, {});
  CHECK(bound >= off);
  CHECK(bound <= (1 + 1e-12) * off);
  CHECK(std::isinf(convex::bound_proved_in_fractions(exact, near, {.limit = 0})));
}

TEST_CASE("few dependent rows get the same multipliers whether their work is limited or not") {
  const NearestPointProblem problem = many_rows_at_a_vertex(4, 12);
  const convex::ExactProblem exact = convex::exact_problem(problem);
  const convex::ExactSolution solution = convex::exact_active_set(exact, {});
  const auto limited = convex::exact_multipliers(exact, solution, true, convex::most_word_operations);
  REQUIRE(limited);
  const ExactMultipliers free = convex::exact_multipliers(exact, solution, true);
  CHECK(convex::nearest(limited->least_norm) == convex::nearest(free.least_norm));
}

TEST_CASE(
    "the ranges of multipliers are the same in any units of the rows, and take no more work in others") {
  const NearestPointProblem problem = many_rows_at_a_vertex(12, 60);
  NearestPointProblem other = problem;
  RowMatrix U = problem.U.dense();
  const auto exponent = [](Index a) { return static_cast<int>((29 * a) % 41) - 20; };
  for (Index a = 0; a < U.rows(); ++a) U.row(a) *= std::ldexp(1.0, exponent(a));
  other.U = convex::ConstraintRows(U);
  constexpr double part = 0.01;
  const auto ranges = [&](const NearestPointProblem& of) {
    const ExactProblem exact = convex::exact_problem(of);
    const auto found = convex::exact_multipliers(exact, convex::exact_active_set(exact, {}), true,
                                                 part * convex::most_word_operations);
    REQUIRE(found);
    return *found->ranges;
  };
  const auto first = ranges(problem), second = ranges(other);
  const auto in_unit = [](const std::optional<convex::Fraction>& end, int shift) {
    return end ? convex::nearest_double(*end) * std::ldexp(1.0, shift) : convex::infinity;
  };
  bool is_free = false;
  for (std::size_t a = 0; a < first.size(); ++a) {
    CHECK(in_unit(first[a].low, 0) == in_unit(second[a].low, exponent(static_cast<Index>(a))));
    CHECK(in_unit(first[a].high, 0) == in_unit(second[a].high, exponent(static_cast<Index>(a))));
    is_free |= !first[a].high || !(*first[a].low == *first[a].high);
  }
  CHECK(is_free);
}
