#include "convex/nearest_point/pivoting/swept_rows.hpp"

#include <doctest/doctest.h>

#include <memory>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/pivoting/gram_solve.hpp"
#include "tests/oracles/planted_problem.hpp"

using convex::Accuracy;
using convex::Index;
using convex::NearestPointProblem;
using convex::SmallKernels;
using convex::SmallTableau;
using convex::Solution;
using convex::Status;
using convex::SweptRows;
using convex::Vector;
using oracles::Difficulty;

namespace {

constexpr double few_roundings = 4e-15;

double scale(const NearestPointProblem& problem, const Vector& x) {
  return std::max({problem.A.norm(x), problem.A.dual_norm(problem.z), 1e-300});
}

/// All that the kernels make of a problem, one after the other.
std::vector<double> outcome(const SmallKernels& kernels, const NearestPointProblem& problem) {
  const auto scene = std::make_unique<SmallTableau>();
  SmallTableau& t = *scene;
  SweptRows(problem, t).begin({});
  std::vector<double> all;
  const auto keep = [&](const double* x, Index count) { all.insert(all.end(), x, x + count); };
  if (!kernels.begin(t) || !kernels.settle(t)) return all;
  keep(t.b, t.m);
  keep(t.q, t.n);
  kernels.correct(t);
  keep(t.dq, t.n);
  keep(t.change, t.size);
  kernels.measure(t);
  kernels.measure_balance(t);
  keep(t.slack, t.m);
  keep(&t.stationarity, 1);
  return all;
}

/// The Gram matrix as its rows held have swept it.
convex::Matrix swept(const SmallKernels& kernels, const SmallTableau& t) {
  alignas(64) double column[SmallTableau::most];
  convex::Matrix all(t.m, t.m);
  for (Index a = 0; a < t.m; ++a) {
    kernels.find_column(t, a, column);
    all.col(a) = Eigen::Map<const Vector>(column, t.m);
  }
  return all;
}

bool is_answered(const NearestPointProblem& problem, Solution& found) {
  SmallTableau tableau;
  SweptRows rows(problem, tableau);
  return convex::GramSolve(rows).solve({}, {}, found);
}

}  // namespace

TEST_CASE("the small tableau gives the same bytes for every processor family") {
  int settled = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Index n = 1 + static_cast<Index>((5 * seed) % 32), m = 1 + static_cast<Index>((11 * seed) % 32);
    const auto [problem, truth] = oracles::planted_problem(seed, n, m, Difficulty::none);
    const std::vector<double> reference = outcome(convex::small_kernels(), problem);
    settled += !reference.empty();
    for (const SmallKernels* kernels : convex::all_small_kernels())
      CHECK(outcome(*kernels, problem) == reference);
  }
  CHECK(settled > 30);
}

TEST_CASE("rows looked at later have the columns of rows looked at at once") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Index n = 9 + static_cast<Index>(seed);
    const auto [problem, truth] = oracles::planted_problem(seed, n, 24, Difficulty::none);
    std::vector<double> reference;
    for (const SmallKernels* kernels : convex::all_small_kernels()) {
      const auto at_once = std::make_unique<SmallTableau>(), later = std::make_unique<SmallTableau>();
      for (SmallTableau* t : {at_once.get(), later.get()}) {
        SweptRows(problem, *t).begin({1, 4, 6});
        if (t == later.get()) t->m = t->stride = 8;
        REQUIRE(kernels->begin(*t));
      }
      for (later->m = 16; later->m <= 24; later->m += 8) kernels->append(*later);
      later->m = 24;
      const convex::Matrix expected = swept(*kernels, *at_once), found = swept(*kernels, *later);
      CHECK((found - expected).norm() <= 1e-12 * expected.norm());
      CHECK((found - found.transpose()).norm() <= 1e-12 * expected.norm());
      const Eigen::Map<const Vector> diagonal(later->swept_diagonal, 24);
      CHECK((found.diagonal() - diagonal).norm() <= 1e-12 * expected.norm());
      const Eigen::Map<const Vector> b(at_once->b, 24), later_b(later->b, 24);
      CHECK((later_b - b).norm() <= 1e-12 * b.norm());
      const std::vector<double> bytes(found.data(), found.data() + found.size());
      if (reference.empty()) reference = bytes;
      CHECK(bytes == reference);
    }
  }
}

TEST_CASE("with many rows to few coordinates the small tableau is right, and its bound holds") {
  int answered = 0, asked = 0;
  for (Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest,
        Difficulty::two_sided_rows, Difficulty::opposite_rows, Difficulty::sparse_rows})
    for (unsigned seed = 0; seed < 40; ++seed) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const Index n = 1 + static_cast<Index>((5 * seed) % 32), m = 33 + static_cast<Index>((37 * seed) % 400);
      const auto [problem, truth] = oracles::planted_problem(seed, n, m, difficulty);
      Solution found;
      ++asked;
      if (!is_answered(problem, found)) continue;
      ++answered;
      CHECK(found.status == Status::solved);
      const double error = problem.A.norm(found.q - truth), unit = scale(problem, truth);
      CHECK(error <= few_roundings * unit);
      CHECK(error <= found.error_bound + few_roundings * unit);
      CHECK(found.slack.minCoeff() >= 0);
      CHECK(found.lambda.cwiseProduct(found.slack).isZero(0));
      CHECK(found.residuals.stationarity <= few_roundings);
      CHECK(found.residuals.feasibility <= few_roundings);
    }
  MESSAGE("answered " << answered << " of " << asked);
  CHECK(answered > asked / 4);
}

TEST_CASE("where the small tableau answers, it is right to rounding, and its bound holds") {
  int answered = 0;
  for (Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::sums_of_rows, Difficulty::at_rest,
        Difficulty::two_sided_rows, Difficulty::opposite_rows, Difficulty::sparse_rows})
    for (unsigned seed = 0; seed < 60; ++seed) {
      CAPTURE(seed);
      CAPTURE(static_cast<int>(difficulty));
      const Index n = 1 + static_cast<Index>((5 * seed) % 32), m = 1 + static_cast<Index>((11 * seed) % 32);
      const auto [problem, truth] = oracles::planted_problem(seed, n, m, difficulty);
      Solution found;
      if (!is_answered(problem, found)) continue;
      ++answered;
      CHECK(found.status == Status::solved);
      const double error = problem.A.norm(found.q - truth), unit = scale(problem, truth);
      CHECK(error <= few_roundings * unit);
      CHECK(error <= found.error_bound + few_roundings * unit);
      CHECK(found.residuals.stationarity <= few_roundings);
      CHECK(found.residuals.feasibility <= few_roundings);
      CHECK(found.residuals.complementarity <= few_roundings);
    }
  CHECK(answered > 15);
  const convex::GalleryFamily& family = *convex::find_family("well-posed");
  for (const Index n : {4, 6, 8, 9, 16, 17, 25, 32}) {
    const convex::GalleryInstance instance = convex::gallery_instance(family, n, family.usual);
    if (!SweptRows::fits(instance.problem)) continue;
    Solution found;
    REQUIRE(is_answered(instance.problem, found));
    CHECK(instance.problem.A.norm(found.q - instance.solution.hi) <=
          few_roundings * scale(instance.problem, instance.solution.hi));
  }
}

TEST_CASE(
    "an answer left in doubles is within its bound of the one rounded right, and the bound within reach") {
  Accuracy doubles;
  doubles.refine = false;
  for (Difficulty difficulty :
       {Difficulty::none, Difficulty::repeated_rows, Difficulty::at_rest, Difficulty::two_sided_rows})
    for (unsigned seed = 0; seed < 40; ++seed) {
      const Index n = 1 + static_cast<Index>((5 * seed) % 61), m = 1 + static_cast<Index>((11 * seed) % 71);
      const auto [problem, truth] = oracles::planted_problem(seed, n, m, difficulty);
      const Solution found = convex::active_set(problem, doubles);
      CHECK(found.status == Status::solved);
      const double error = problem.A.norm(found.q - truth), unit = scale(problem, truth);
      CHECK(error <= found.error_bound + few_roundings * unit);
      CHECK(found.error_bound <= 1e-10 * unit);
    }
}

TEST_CASE("a tolerance that doubles cannot meet brings the correction in") {
  const convex::GalleryFamily& family = *convex::find_family("well-posed");
  const NearestPointProblem problem = convex::gallery_instance(family, 12, family.usual).problem;
  Accuracy doubles, sharp;
  doubles.refine = sharp.refine = false;
  sharp.tolerance = 1e-15;
  CHECK(convex::active_set(problem, sharp).error_bound < convex::active_set(problem, doubles).error_bound);
  CHECK(convex::active_set(problem, sharp).q == convex::active_set(problem).q);
}

TEST_CASE("where rows leave no motion, the point is 0 and not what rounding leaves of it") {
  convex::RowMatrix U(3, 2);
  U << 2, -3, 1, 0, 0, 1;
  Vector z(2);
  z << -3, -5;
  const Solution found = convex::active_set(
      {convex::Metric::identity(2), z, convex::ConstraintRows(U), Vector::Zero(3), {0}}, {});
  CHECK(found.status == Status::solved);
  CHECK(found.q == Vector::Zero(2));
  CHECK(found.residuals.feasibility == 0);
}
