#include "tests/convex/nearest_point/pivoting/gram_answer.hpp"

#include <doctest/doctest.h>

#include <array>
#include <optional>
#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/methods.hpp"

using convex::ConstraintRows;
using convex::Index;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::Solution;
using convex::Status;
using convex::Vector;

namespace {

Solution exact(const NearestPointProblem& problem) {
  for (const convex::Method& method : convex::methods())
    if (method.name == "exact") return method.solve(problem, {});
  return {};
}

/// Small integers, the later half of the rows made of the others: multiples, sums, some of them off by
/// `off` in one entry, some turned round. More than `least` rows, for so many coordinates.
NearestPointProblem degenerate(unsigned seed, double off, Index least = 0) {
  std::mt19937 generator(seed);
  const auto integer = [&](int low, int high) {
    return static_cast<double>(std::uniform_int_distribution<int>(low, high)(generator));
  };
  const auto below = [&](Index n) { return static_cast<Index>(integer(0, static_cast<int>(n) - 1)); };
  const Index n = 2 + below(4) + least / 8, some = 1 + below(n + 1), m = some + 1 + below(3 * n) + least;
  Matrix B(n, n);
  for (Index i = 0; i < B.size(); ++i) B.data()[i] = integer(-2, 2);
  const Matrix A = B * B.transpose() + static_cast<double>(n) * Matrix::Identity(n, n);
  convex::RowMatrix U(m, n);
  for (Index i = 0; i < U.size(); ++i) U.data()[i] = integer(-2, 2);
  for (Index a = some; a < m; ++a) {
    U.row(a) = (integer(1, 2) * U.row(below(some)) + integer(0, 1) * U.row(below(some))).eval();
    if (integer(0, 1) > 0) U(a, below(n)) += off;
    if (integer(0, 3) == 0) U.row(a) *= -1;
  }
  Vector x(n), lambda = Vector::Zero(m);
  for (Index i = 0; i < n; ++i) x[i] = integer(-5, 5);
  Vector s = U * x;
  for (Index a = 0; a < m; ++a) {
    const double kind = integer(0, 2);
    if (kind == 0) lambda[a] = integer(0, 6);
    if (kind == 1) s[a] -= integer(0, 4);
  }
  Vector z = A * x - U.transpose() * lambda;
  if (seed % 2 == 0)
    for (Index i = 0; i < n; ++i) z[i] += integer(-3, 3);
  return {Metric::dense(A), z, ConstraintRows(U), s, {}};
}

}  // namespace

TEST_CASE("rows that are sums and multiples of others leave the answer as it is in fractions") {
  for (unsigned seed = 0; seed < 150; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = degenerate(seed, 0);
    const Solution truth = exact(problem), found = convex::active_set(problem);
    REQUIRE(found.status == truth.status);
    if (truth.status != Status::solved) continue;
    CHECK(problem.A.norm(found.q - truth.q) <=
          gram_matrix::few_roundings * gram_matrix::scale(problem, truth.q));
  }
}

TEST_CASE("many rows that are sums and multiples of few leave the answer as it is in fractions") {
  for (unsigned seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = degenerate(seed, 0, 48);
    const Solution truth = exact(problem);
    if (truth.status != Status::solved) continue;
    const std::optional<Solution> found = gram_matrix::answer(problem);
    REQUIRE(found.has_value());
    CHECK(problem.A.norm(found->q - truth.q) <=
          gram_matrix::few_roundings * gram_matrix::scale(problem, truth.q));
    CHECK(found->slack.minCoeff() >= 0);
  }
}

TEST_CASE("multipliers of rows that just hold, made by rounding alone, are there and 0 as in fractions") {
  std::mt19937 generator(5);
  std::uniform_int_distribution<int> steps(-8, 8);
  std::uniform_real_distribution<double> part(0.1, 1);
  for (const auto& [n, m, strong, weak] : {std::array<Index, 4>{6, 9, 2, 3}, {12, 24, 6, 12}, {12, 40, 4, 4}})
    for (int turn = 0; turn < 12; ++turn) {
      CAPTURE(n);
      CAPTURE(turn);
      Matrix B(n, n);
      convex::RowMatrix U(m, n);
      Vector x(n), lambda = Vector::Zero(m);
      for (Index i = 0; i < B.size(); ++i) B.data()[i] = part(generator) - 0.5;
      for (Index i = 0; i < U.size(); ++i) U.data()[i] = steps(generator) / 16.0;
      for (Index i = 0; i < n; ++i) x[i] = steps(generator) / 4.0;
      const Matrix A = B * B.transpose() + Matrix::Identity(n, n);
      Vector s = U * x;
      for (Index a = 0; a < m; ++a)
        if (a < strong)
          lambda[a] = part(generator);
        else if (a >= strong + weak)
          s[a] -= part(generator);
      const NearestPointProblem problem{
          Metric::dense(A), A * x - U.transpose() * lambda, ConstraintRows(U), s, {}};
      const Solution truth = exact(problem), found = convex::active_set(problem);
      REQUIRE(truth.status == Status::solved);
      REQUIRE(found.status == Status::solved);
      CHECK(problem.A.norm(found.q - truth.q) <=
            gram_matrix::few_roundings * gram_matrix::scale(problem, truth.q));
      const double length = truth.lambda.maxCoeff();
      for (Index a = 0; a < m; ++a) {
        CHECK((found.lambda[a] > 0) == (truth.lambda[a] > 0));
        CHECK(std::abs(found.lambda[a] - truth.lambda[a]) <= 1e-13 * length);
      }
    }
}

TEST_CASE("rows that are sums of others but for an angle below rounding are judged right or not at all") {
  for (const double off : {0x1p-30, 0x1p-44, 0x1p-52, 0x1p-54})
    for (unsigned seed = 0; seed < 150; ++seed) {
      CAPTURE(seed);
      CAPTURE(off);
      const NearestPointProblem problem = degenerate(seed, off);
      const Solution truth = exact(problem), found = convex::active_set(problem);
      if (found.status != Status::solved || truth.status != Status::solved) continue;
      CHECK(problem.A.norm(found.q - truth.q) <= 1e-9 * gram_matrix::scale(problem, truth.q));
    }
}

TEST_CASE("no motion of rounding is a way up for a row that depends on those held, whatever the masses are") {
  // Along the rows q1 >= q0, q2 >= q1, q3 >= q2 + 1e-27 and q0 >= q3.
  Vector masses(4), z(4), s(4);
  masses << 1, 3, 1e-8, 0.1;
  z << -1, 1e-17, 0.1, -1;
  s << 0, 0, 1e-17, 0;
  convex::RowMatrix U(4, 4);
  U << -1e10, 1e10, 0, 0, 0, -0.1, 0.1, 0, 0, 0, -1e10, 1e10, 1, 0, 0, -1;
  const NearestPointProblem ring{Metric::diagonal(masses), z, ConstraintRows(U), s, {}};
  CHECK(convex::active_set(ring).status == Status::infeasible);
  CHECK(convex::active_set(ring, {.limit = 0}).status != Status::solved);
}

TEST_CASE("repeated rows, sums of rows and many rows to a coordinate are settled by the Gram matrix") {
  struct Kind {
    const char* family;
    Index n;
    double difficulty;
  };
  for (const auto& [family, n, difficulty] :
       {Kind{"repeated", 12, 4}, Kind{"repeated", 40, 4}, Kind{"redundant", 12, 1}, Kind{"redundant", 40, 1},
        Kind{"tall", 10, 10}, Kind{"tall", 10, 100}, Kind{"tall", 30, 30}, Kind{"well-posed", 40, 0.5}})
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U, 5U}) {
      CAPTURE(family);
      CAPTURE(seed);
      const convex::GalleryInstance instance =
          convex::gallery_instance(*convex::find_family(family), n, difficulty, seed);
      const std::optional<Solution> found = gram_matrix::answer(instance.problem);
      REQUIRE(found.has_value());
      const double unit = gram_matrix::scale(instance.problem, instance.solution.hi);
      CHECK(instance.problem.A.norm(found->q - instance.solution.hi) <= gram_matrix::few_roundings * unit);
      CHECK(found->error_bound <= gram_matrix::few_roundings * unit);
      CHECK(found->slack.minCoeff() >= 0);
      CHECK(found->lambda.minCoeff() >= 0);
      CHECK(found->residuals.feasibility <= gram_matrix::few_roundings);
    }
}
