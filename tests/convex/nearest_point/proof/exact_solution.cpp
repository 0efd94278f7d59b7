#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "convex/exact/integer_system.hpp"
#include "convex/exact/positive_definite.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_point/proof/exact_method.hpp"
#include "tests/oracles/full_mantissa.hpp"
#include "tests/oracles/planted_problem.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::ExactProblem;
using convex::ExactSolution;
using convex::Index;
using convex::Matrix;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Status;
using convex::Vector;
using oracles::Difficulty;
using oracles::full_mantissa;
using oracles::Rational;
using oracles::RationalVector;

namespace {

constexpr Difficulty difficulties[]{
    Difficulty::none,           Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest,
    Difficulty::two_sided_rows, Difficulty::opposite_rows, Difficulty::sparse_rows};

/// Some rows, right or wrong.
std::vector<Index> any_rows(unsigned seed, Index m) {
  std::vector<Index> rows(static_cast<std::size_t>(m));
  std::iota(rows.begin(), rows.end(), Index{0});
  std::shuffle(rows.begin(), rows.end(), std::mt19937(seed));
  rows.resize(rows.size() / 2);
  return rows;
}

convex::ExactVector fractions(const std::vector<convex::Fraction>& entries) {
  return convex::exact_vector(entries);
}

bool is_solution(const NearestPointProblem& problem, const ExactSolution& found) {
  return found.status == Status::solved &&
         oracles::is_exact_solution(problem, {oracles::rationals(found.q), oracles::rationals(found.lambda)});
}

}  // namespace

TEST_CASE("an exact solution satisfies every condition in fractions, whatever rows were guessed") {
  for (const Difficulty difficulty : difficulties)
    for (unsigned seed = 0; seed < 12; ++seed) {
      const Index n = 1 + static_cast<Index>(seed % 7), m = static_cast<Index>((5 * seed) % 17);
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const NearestPointProblem problem = oracles::planted_problem(seed, n, m, difficulty).problem;
      const ExactProblem exact = convex::exact_problem(problem);
      CHECK(is_solution(problem, convex::exact_active_set(exact, convex::likely_active_rows(problem))));
      CHECK(is_solution(problem, convex::exact_active_set(exact, {})));
      CHECK(is_solution(problem, convex::exact_active_set(exact, any_rows(seed, m))));
    }
  for (unsigned seed = 0; seed < 6; ++seed) {
    const NearestPointProblem problem = full_mantissa(seed, 6, 10);
    const ExactProblem exact = convex::exact_problem(problem);
    CHECK(is_solution(problem, convex::exact_active_set(exact, convex::likely_active_rows(problem))));
    CHECK(is_solution(problem, convex::exact_active_set(exact, any_rows(seed, 10))));
  }
}

TEST_CASE("the checker refuses a solution with one digit changed") {
  const NearestPointProblem problem = oracles::planted_problem(5, 4, 6, Difficulty::none).problem;
  const ExactSolution found = convex::exact_active_set(convex::exact_problem(problem), {});
  REQUIRE(is_solution(problem, found));
  for (std::size_t i = 0; i < found.q.numerators.size(); ++i) {
    ExactSolution wrong = found;
    wrong.q.numerators[i] += 1;
    CHECK_FALSE(is_solution(problem, wrong));
  }
  for (std::size_t a = 0; a < found.lambda.numerators.size(); ++a) {
    ExactSolution wrong = found;
    wrong.lambda.numerators[a] += 1;
    CHECK_FALSE(is_solution(problem, wrong));
  }
}

TEST_CASE("rows that contradict each other give weights that prove it in integers") {
  for (unsigned seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    NearestPointProblem problem =
        oracles::planted_problem(seed, 4, 9, seed % 2 == 0 ? Difficulty::none : Difficulty::two_sided_rows)
            .problem;
    // Twice row 0 plus row 1, from the other side and a little too high.
    RowMatrix U = problem.U.dense();
    U.row(8) = -2 * U.row(0) - U.row(1);
    problem.s[8] = -2 * problem.s[0] - problem.s[1] + 0x1p-40;
    std::erase(problem.two_sided, 8);
    problem.U = convex::ConstraintRows(U);
    const ExactProblem exact = convex::exact_problem(problem);
    for (const std::vector<Index>& guess : {convex::likely_active_rows(problem), any_rows(seed, 9)}) {
      const ExactSolution found = convex::exact_active_set(exact, guess);
      REQUIRE(found.status == Status::infeasible);
      CHECK(oracles::is_farkas_witness(problem, convex::nearest({found.farkas, 1}), 0));
    }
  }
}

TEST_CASE("a third taken as a double contradicts itself, a third does not") {
  // q >= 1/3 and -q >= -1/3 with the first rounded up and the second rounded down.
  const double low = std::nextafter(1.0 / 3, 1.0);
  NearestPointProblem problem{convex::Metric::identity(1),
                              Vector::Zero(1),
                              convex::ConstraintRows(RowMatrix{{1.0}, {-1.0}}),
                              Vector{{low, -1.0 / 3}},
                              {}};
  CHECK(convex::exact_method(problem, {}).status == Status::infeasible);
  const convex::Fraction third{1, 3};
  const ExactProblem exact =
      convex::exact_problem({fractions({convex::Fraction{1, 1}})}, fractions({convex::Fraction{}}),
                            {fractions({convex::Fraction{1, 1}}), fractions({convex::Fraction{-1, 1}})},
                            fractions({third, -third}), {});
  const ExactSolution found = convex::exact_active_set(exact, {});
  CHECK(convex::text(convex::entry(found.q, 0)) == "1/3");
}

TEST_CASE("the bound on the distance to the exact point is the distance, rounded up in its last digits") {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const NearestPointProblem problem = full_mantissa(seed, 5, 8);
    const ExactProblem exact = convex::exact_problem(problem);
    const ExactSolution found = convex::exact_active_set(exact, {});
    Vector q = convex::nearest(found.q);
    for (const double shift : {0.0, 1e-12, 1e-3}) {
      q[0] += shift;
      const double bound = convex::distance_above(exact, q, found.q);
      const double truth =
          oracles::relative_error(problem, q, {oracles::rationals(found.q), {}}, 1.0);  // itself rounded
      CHECK(bound >= truth * (1 - 0x1p-50));
      CHECK(bound <= truth * (1 + 0x1p-46));
    }
  }
}

TEST_CASE("a matrix is positive definite exactly when its least eigenvalue is positive, near 0 too") {
  for (const int excess : {-1, 0, 1}) {
    // ones + (excess / 2^80) identity: its least eigenvalue is excess / 2^80.
    convex::IntegerRows A(5, convex::IntegerVector(5, convex::Integer::shifted(1, 80)));
    for (std::size_t i = 0; i < 5; ++i) A[i][i] += excess;
    CHECK(convex::is_positive_definite(A) == (excess > 0));
  }
  CHECK_FALSE(convex::is_positive_definite({{2, 3}, {3, 4}}));
  CHECK(convex::is_positive_definite({{convex::Integer::shifted(1, 900), 1}, {1, 1}}));
  // Formed in doubles, a Gram matrix of two nearly parallel columns need not be definite.
  NearestPointProblem problem{convex::Metric::dense(Matrix{{1, 0.5}, {0.5, 1}}),
                              Vector::Zero(2),
                              convex::ConstraintRows(RowMatrix(0, 2)),
                              Vector(0),
                              {}};
  CHECK_NOTHROW(convex::exact_problem(problem));
  const convex::ExactRows flat{fractions({convex::Fraction{1, 1}, convex::Fraction{1, 1}}),
                               fractions({convex::Fraction{1, 1}, convex::Fraction{1, 1}})};
  CHECK_THROWS_AS(convex::exact_problem(flat, convex::exact_vector(Vector::Zero(2)), {}, {}, {}),
                  convex::InvalidInput);
}

TEST_CASE("integer systems are solved exactly, short answers and long ones, or found singular") {
  std::mt19937_64 generator(3);
  for (const unsigned long shift : {0UL, 30UL, 200UL})
    for (const std::size_t n : {1U, 2U, 5U, 12U}) {
      convex::IntegerRows M(n);
      for (convex::IntegerVector& row : M)
        for (std::size_t j = 0; j < n; ++j)
          row.push_back(
              convex::Integer::shifted(static_cast<std::int64_t>(generator() % 2001) - 1000, shift) +
              static_cast<std::int64_t>(generator() % 7));
      convex::IntegerVector b;
      for (std::size_t i = 0; i < n; ++i) b.push_back(static_cast<std::int64_t>(generator() % 99) - 49);
      const auto system = convex::IntegerSystem::prepared(M);
      REQUIRE(system);
      const RationalVector x = oracles::rationals(system->solve(b));
      for (std::size_t i = 0; i < n; ++i) {
        Rational sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += Rational(M[i][j].text()) * x[j];
        CHECK((sum == Rational(b[i].text())));
      }
    }
  CHECK_FALSE(convex::IntegerSystem::prepared({{1, 2}, {2, 4}}));
  // A multiple of the first prime looks singular there, and is not.
  CHECK(convex::IntegerSystem::prepared({{(std::int64_t{1} << 62) - 57}}));
}

TEST_CASE("a system that rows and columns were added to and taken from solves as one made anew") {
  std::mt19937_64 generator(7);
  const auto number = [&] { return convex::Integer(static_cast<std::int64_t>(generator() % 2001) - 1000); };
  constexpr std::size_t n = 40;  // beyond one block of the elimination
  convex::IntegerRows M(n);
  for (convex::IntegerVector& row : M)
    for (std::size_t j = 0; j < n; ++j) row.push_back(number());
  auto system = convex::IntegerSystem::prepared(M);
  REQUIRE(system);
  const convex::IntegerSystem first = *system;
  convex::IntegerVector row, column, b;
  for (std::size_t j = 0; j < n; ++j) {
    row.push_back(number());
    column.push_back(number());
    b.push_back(number());
  }
  REQUIRE(system->append(row, column));
  REQUIRE(system->remove(3));
  for (std::size_t i = 0; i < n; ++i) M[i].push_back(column[i]);
  row.emplace_back(0);
  M.push_back(row);
  M.erase(M.begin() + 3);
  for (convex::IntegerVector& kept : M) kept.erase(kept.begin() + 3);
  const auto anew = convex::IntegerSystem::prepared(M);
  REQUIRE(anew);
  const convex::ExactVector x = system->solve(b), y = anew->solve(b);
  for (std::size_t i = 0; i < n; ++i) CHECK((convex::entry(x, i) == convex::entry(y, i)));
  CHECK(first.solve(b).numerators.size() == n);
  CHECK_FALSE(system->append(convex::IntegerVector(n, 0), convex::IntegerVector(n, 0)));
}

TEST_CASE("a matrix that is definite by 2^-80 has a factor of doubles that gives it back, and its inverse") {
  // ones + 2^-80 identity times 2^80: its inverse is (identity - ones / (n + 2^-80)) to leading order.
  const std::size_t n = 4;
  convex::IntegerRows A(n, convex::IntegerVector(n, convex::Integer::shifted(1, 80)));
  for (std::size_t i = 0; i < n; ++i) A[i][i] += 1;
  CHECK_FALSE(convex::cholesky_factor(A, 1).has_value());
  const auto L = convex::cholesky_factor(A, convex::most_word_operations);
  REQUIRE(L.has_value());
  const Matrix ones = Matrix::Ones(4, 4);
  CHECK((*L * L->transpose() - 0x1p80 * ones).cwiseAbs().maxCoeff() <= 0x1p30);
  const convex::Metric metric = convex::Metric::dense(0x1p80 * ones, *L);
  const Vector off = Eigen::Vector4d(1, -1, 2, -2);  // off the diagonal A is the identity
  CHECK((metric.solve(off) - off).cwiseAbs().maxCoeff() <= 1e-14);
  CHECK(metric.norm(off) == doctest::Approx(std::sqrt(10)).epsilon(1e-14));
  A[0][0] += -2;
  CHECK_FALSE(convex::cholesky_factor(A, convex::most_word_operations).has_value());
}
