#include <doctest/doctest.h>

#include <random>

#include "convex/linear_algebra/sparse_factor.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/isotonic/chain.hpp"
#include "convex/nearest_point/obstacle/obstacle.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"
#include "convex/nearest_point/sparse/sparse_active_set.hpp"
#include "tests/oracles/nearest_point_error.hpp"

using convex::ConstraintRows;
using convex::GalleryInstance;
using convex::Index;
using convex::Metric;
using convex::NearestPointProblem;
using convex::Solution;
using convex::SparseRows;
using convex::Status;
using convex::Vector;
using oracles::few_roundings;

namespace {

double relative_error(const GalleryInstance& instance, const Solution& found) {
  const NearestPointProblem& problem = instance.problem;
  return problem.A.norm(found.q - instance.solution.hi) / oracles::scale(problem, instance.solution.hi);
}

/// A string of bodies with gaps, a floor under the first when asked for.
NearestPointProblem string_of_bodies(Index n, unsigned seed, bool floor) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const Index m = n - 1 + (floor ? 1 : 0);
  Vector mass(n), z(n), s(m);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < n; ++i) {
    mass[i] = std::exp(2 * normal(generator));
    z[i] = mass[i] * (normal(generator) - (seed % 4 == 0 ? 2 : 0));
  }
  Index a = 0;
  if (floor) entries.emplace_back(a++, 0, 2.0);
  for (Index i = 0; i + 1 < n; ++i, ++a) {
    entries.emplace_back(a, i, i % 3 == 0 ? -3.0 : -1.0);
    entries.emplace_back(a, i + 1, i % 3 == 0 ? 3.0 : 1.0);
  }
  for (Index k = 0; k < m; ++k) s[k] = seed % 3 == 0 ? std::round(normal(generator)) : normal(generator);
  SparseRows U(m, n);
  U.setFromTriplets(entries.begin(), entries.end());
  return {Metric::diagonal(mass), z, ConstraintRows(U), s, {}};
}

}  // namespace

TEST_CASE("pooling solves a string of bodies as the general method does, multipliers included") {
  for (unsigned seed = 0; seed < 120; ++seed) {
    CAPTURE(seed);
    const NearestPointProblem problem = string_of_bodies(2 + seed % 30, seed, seed % 2 == 0);
    const std::optional<Solution> pooled = convex::solve_chain(problem);
    REQUIRE(pooled.has_value());
    const Solution general = convex::active_set(problem);
    REQUIRE(pooled->status == Status::solved);
    const double scale = std::max(problem.A.norm(general.q), problem.A.dual_norm(problem.z));
    CHECK(problem.A.norm(pooled->q - general.q) <= 1e-15 * scale);
    CHECK((pooled->lambda - general.lambda).cwiseAbs().maxCoeff() <= 1e-14 * (1 + general.lambda.maxCoeff()));
    CHECK(pooled->residuals.feasibility <= few_roundings);
    CHECK(pooled->residuals.complementarity <= few_roundings);
  }
}

TEST_CASE("what is no chain is not taken for one") {
  NearestPointProblem problem = string_of_bodies(5, 1, false);
  problem.two_sided = {1};
  CHECK_FALSE(convex::solve_chain(problem).has_value());
  problem.two_sided.clear();
  SparseRows U = problem.U.sparse();
  U.coeffRef(2, 2) *= 2;
  problem.U = ConstraintRows(U);
  CHECK_FALSE(convex::solve_chain(problem).has_value());
}

TEST_CASE("sparse families with a planted truth are solved to rounding") {
  for (const char* name : {"chain", "hexagonal-packing"}) {
    const convex::GalleryFamily* family = convex::find_family(name);
    REQUIRE(family != nullptr);
    for (double difficulty : family->ladder)
      for (Index size : {20, 150, 400}) {
        CAPTURE(name);
        CAPTURE(difficulty);
        CAPTURE(size);
        const GalleryInstance instance = convex::gallery_instance(*family, size, difficulty);
        const bool by_factor = difficulty <= 1e9;  // beyond, it may say that it gave up
        const Solution sparse = convex::sparse_active_set(instance.problem);
        if (by_factor) {
          REQUIRE(sparse.status == Status::solved);
          CHECK(relative_error(instance, sparse) <= few_roundings);
        } else if (sparse.status == Status::solved) {
          CHECK(instance.problem.A.norm(sparse.q - instance.solution.hi) <= 10 * sparse.error_bound);
        }
        const Solution found = convex::automatic(instance.problem);
        CHECK(found.status == Status::solved);
        CHECK(relative_error(instance, found) <= few_roundings);
      }
  }
}

TEST_CASE(
    "an obstacle problem on a grid is solved by multigrid to rounding, and by the general method alike") {
  const convex::GalleryFamily* family = convex::find_family("obstacle");
  REQUIRE(family != nullptr);
  for (double difficulty : family->ladder)
    for (Index side : {8, 13, 32, 50}) {
      CAPTURE(difficulty);
      CAPTURE(side);
      const GalleryInstance instance = convex::gallery_instance(*family, side, difficulty);
      const std::optional<Solution> found = convex::solve_obstacle(instance.problem);
      REQUIRE(found.has_value());
      CHECK(found->status == Status::solved);
      CHECK(relative_error(instance, *found) <= few_roundings);
      CHECK((found->lambda - instance.multipliers).cwiseAbs().maxCoeff() <= few_roundings);
      CHECK(convex::automatic(instance.problem).method == "obstacle");
      convex::Accuracy full;
      full.reduce = false;
      if (side == 32)
        CHECK(relative_error(instance, convex::automatic(instance.problem, full)) <= few_roundings);
    }
}

TEST_CASE(
    "a membrane held at some points, down or up, keeps to the rest of the obstacle: no factor is needed") {
  for (unsigned seed = 0; seed < 6; ++seed)
    for (bool all : {false, true}) {
      CAPTURE(seed);
      CAPTURE(all);
      NearestPointProblem problem =
          convex::gallery_instance(*convex::find_family("obstacle"), 18, 0.5).problem;
      std::mt19937 generator(seed);
      std::normal_distribution<double> normal;
      for (Index a = 0; a < problem.rows(); ++a)
        if (all || generator() % 3 == 0) {
          problem.two_sided.push_back(a);
          problem.s[a] += 0.01 * normal(generator);
        }
      const std::optional<Solution> found = convex::solve_obstacle(problem);
      REQUIRE(found.has_value());
      CHECK(found->status == Status::solved);
      const Solution general = convex::active_set(problem);
      REQUIRE(general.status == Status::solved);
      const double scale = oracles::scale(problem, general.q);
      CHECK(problem.A.norm(found->q - general.q) <= few_roundings * scale);
      CHECK((found->lambda - general.lambda).cwiseAbs().maxCoeff() <=
            few_roundings * (1 + general.lambda.cwiseAbs().maxCoeff()));
      CHECK(found->residuals.feasibility <= few_roundings);
      CHECK(found->residuals.stationarity <= few_roundings);
    }
}

TEST_CASE("a grid is told from what is nearly one") {
  GalleryInstance instance = convex::gallery_instance(*convex::find_family("obstacle"), 10, 0.5);
  convex::SparseMatrix A = instance.problem.A.sparse_gram();
  A.coeffRef(37, 37) = 5;
  instance.problem.A = Metric::sparse(A);
  CHECK_FALSE(convex::solve_obstacle(instance.problem).has_value());
  A.coeffRef(37, 37) = 4;
  A.coeffRef(9, 10) = A.coeffRef(10, 9) = -1;  // from the end of a row to the next
  instance.problem.A = Metric::sparse(A);
  CHECK_FALSE(convex::solve_obstacle(instance.problem).has_value());
}

TEST_CASE("a sparse problem without a solution is refused with weights that prove it") {
  for (Index n : {10, 300}) {
    // A string tied to both ends of a room that is too short, and redundant rows beside.
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i + 1 < n; ++i) {
      entries.emplace_back(i, i, -1.0);
      entries.emplace_back(i, i + 1, 1.0);
    }
    entries.emplace_back(n - 1, 0, 1.0);
    entries.emplace_back(n - 1, n - 1, -1.0);
    SparseRows U(n, n);
    U.setFromTriplets(entries.begin(), entries.end());
    Vector s = Vector::Ones(n);
    s[n - 1] = -static_cast<double>(n) + 2;
    const NearestPointProblem problem{Metric::identity(n), Vector::Zero(n), ConstraintRows(U), s, {}};
    const Solution found = convex::sparse_active_set(problem);
    REQUIRE(found.status == Status::infeasible);
    CHECK(convex::proves_infeasibility(problem, found.farkas, 1e3));
  }
}

TEST_CASE(
    "a string that hangs far above the floor between long contacts is found, though all held is far off") {
  // Slopes fall by one a bead from 1681 to -1189, then rise to 0: 1681·1682/2 = 1189², so it lands at 0.
  constexpr Index up = 1681, down = 1189, loaded = up + down, resting = 2000, half = loaded + down - 1;
  const Index n = 2 * half + resting;
  Vector q = Vector::Zero(n);
  double height = 0;
  for (Index k = 0; k < half; ++k) {
    height += static_cast<double>(k <= loaded ? up - k : k - loaded - down);
    q[k] = q[n - 1 - k] = height;
  }
  std::vector<Eigen::Triplet<double>> entries, ones;
  for (Index i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.0);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0);
    if (i > 0) entries.emplace_back(i - 1, i, -1.0);
    ones.emplace_back(i, i, 1.0);
  }
  Eigen::SparseMatrix<double> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  SparseRows U(n, n);
  U.setFromTriplets(ones.begin(), ones.end());
  const Vector lambda = (q.array() == 0).cast<double>();
  const NearestPointProblem problem{
      Metric::sparse(A), A * q - lambda, ConstraintRows(U), Vector::Zero(n), {}};
  const Solution found = convex::sparse_active_set(problem);
  REQUIRE(found.status == Status::solved);
  CHECK(problem.A.norm(found.q - q) <= few_roundings * problem.A.norm(q));
  CHECK((found.lambda - lambda).cwiseAbs().maxCoeff() <= 1e-9);
}

TEST_CASE("rows with many entries are held beside the factor") {
  const Index n = 300;
  std::mt19937 generator(3);
  std::uniform_int_distribution<int> integer(-3, 3);
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < n; ++i) {
    entries.emplace_back(0, i, 1.0);
    entries.emplace_back(1, i, i % 2 == 0 ? 1.0 : -1.0);
    entries.emplace_back(2 + i, i, 1.0);
  }
  SparseRows U(n + 2, n);
  U.setFromTriplets(entries.begin(), entries.end());
  Vector q(n), lambda = Vector::Zero(n + 2);
  for (Index i = 0; i < n; ++i) q[i] = std::max(0, integer(generator));
  Vector s = Vector::Zero(n + 2);
  s[0] = q.sum();
  s[1] = U.row(1).dot(q);
  lambda[0] = 2;
  lambda[1] = -3;
  for (Index i = 0; i < n; ++i) lambda[2 + i] = q[i] > 0 ? 0 : 1 + std::abs(integer(generator));
  const Vector z = q - U.transpose() * lambda;
  const NearestPointProblem problem{Metric::identity(n), z, ConstraintRows(U), s, {1}};
  const Solution found = convex::sparse_active_set(problem);
  REQUIRE(found.status == Status::solved);
  CHECK((found.q - q).norm() <= few_roundings * q.norm());
  CHECK((found.lambda - lambda).cwiseAbs().maxCoeff() <= 1e-12);
}

TEST_CASE("the sparse factor solves quasi-definite systems in any pattern") {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (Index n : {1, 2, 7, 40, 150}) {
    std::vector<convex::linear_algebra::SparseFactor::Place> places;
    std::vector<double> values;
    convex::Matrix K = convex::Matrix::Zero(n, n);
    const auto put = [&](Index i, Index j, double value) {
      places.push_back({static_cast<int>(i), static_cast<int>(j)});
      values.push_back(value);
      K(i, j) += value;
      if (i != j) K(j, i) += value;
    };
    const Index split = n - n / 4;
    for (Index i = 0; i < n; ++i) put(i, i, i < split ? 10 : -1);
    for (Index k = 0; k < 2 * n; ++k) {
      const Index i = static_cast<Index>(generator() % static_cast<unsigned>(n));
      const Index j = static_cast<Index>(generator() % static_cast<unsigned>(n));
      if ((i < split) != (j < split)) put(i, j, normal(generator));
    }
    convex::linear_algebra::SparseFactor factor(n, places);
    const std::vector<Index> slots = factor.slots(places);
    for (std::size_t k = 0; k < slots.size(); ++k)
      factor.values()[static_cast<std::size_t>(slots[k])] += values[k];
    REQUIRE(factor.factor());
    const Vector x = Vector::LinSpaced(n, -1, 1);
    Vector found = K * x;
    factor.solve(found);
    CHECK((found - x).norm() <= 1e-12 * (1 + x.norm()));
  }
}
