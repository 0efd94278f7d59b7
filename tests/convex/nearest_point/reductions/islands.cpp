#include <doctest/doctest.h>

#include <algorithm>

#include "convex/invalid_input.hpp"
#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/optimality/farkas.hpp"
#include "tests/oracles/nearest_point_error.hpp"
#include "tests/oracles/planted_problem.hpp"

using convex::Index;
using convex::LeftOutBecause;
using convex::Matrix;
using convex::Metric;
using convex::NearestPointProblem;
using convex::RowMatrix;
using convex::Solution;
using convex::Status;
using convex::Vector;
using oracles::Difficulty;
using oracles::few_roundings;

namespace {

/// Planted problems side by side, coordinates and rows shuffled, with the solution of the whole.
struct Archipelago {
  NearestPointProblem problem;
  Vector solution;
};

Archipelago archipelago(unsigned seed, Index parts, Difficulty difficulty, bool sparse) {
  std::mt19937 generator(seed);
  std::vector<oracles::PlantedProblem> islands;
  Index n = 0, m = 0;
  for (Index k = 0; k < parts; ++k) {
    const unsigned part_seed = seed * 100 + static_cast<unsigned>(k);
    islands.push_back(oracles::planted_problem(part_seed, 1 + static_cast<Index>(part_seed % 5),
                                               static_cast<Index>((3 * part_seed) % 7), difficulty));
    n += islands.back().problem.dimension();
    m += islands.back().problem.rows();
  }
  std::vector<Index> column(static_cast<std::size_t>(n)), row(static_cast<std::size_t>(m));
  for (Index i = 0; i < n; ++i) column[static_cast<std::size_t>(i)] = i;
  for (Index a = 0; a < m; ++a) row[static_cast<std::size_t>(a)] = a;
  std::shuffle(column.begin(), column.end(), generator);
  std::shuffle(row.begin(), row.end(), generator);
  Matrix A = Matrix::Zero(n, n);
  RowMatrix U = RowMatrix::Zero(m, n);
  Vector z(n), s(m), solution(n);
  std::vector<Index> two_sided;
  std::size_t first = 0, first_row = 0;
  for (const auto& [part, x] : islands) {
    for (Index i = 0; i < x.size(); ++i) {
      const Index to = column[first + static_cast<std::size_t>(i)];
      z[to] = part.z[i];
      solution[to] = x[i];
      for (Index j = 0; j < x.size(); ++j)
        A(to, column[first + static_cast<std::size_t>(j)]) = part.A.dense_gram()(i, j);
    }
    for (Index a = 0; a < part.rows(); ++a) {
      const Index to = row[first_row + static_cast<std::size_t>(a)];
      s[to] = part.s[a];
      for (Index j = 0; j < x.size(); ++j)
        U(to, column[first + static_cast<std::size_t>(j)]) = part.U.dense()(a, j);
    }
    for (Index a : part.two_sided) two_sided.push_back(row[first_row + static_cast<std::size_t>(a)]);
    first += static_cast<std::size_t>(x.size());
    first_row += static_cast<std::size_t>(part.rows());
  }
  std::sort(two_sided.begin(), two_sided.end());
  Metric metric = sparse ? Metric::sparse(A.sparseView()) : Metric::dense(A);
  convex::ConstraintRows rows =
      sparse ? convex::ConstraintRows(convex::SparseRows(U.sparseView())) : convex::ConstraintRows(U);
  return {{metric, z, rows, s, two_sided}, solution};
}

NearestPointProblem without(const NearestPointProblem& problem, const std::vector<convex::LeftOutRow>& rows) {
  std::vector<Index> kept;
  for (Index a = 0; a < problem.rows(); ++a)
    if (std::none_of(rows.begin(), rows.end(), [a](const convex::LeftOutRow& out) { return out.row == a; }))
      kept.push_back(a);
  NearestPointProblem part{
      problem.A, problem.z, problem.U.select(kept), Vector(static_cast<Index>(kept.size())), {}};
  for (std::size_t k = 0; k < kept.size(); ++k) {
    part.s[static_cast<Index>(k)] = problem.s[kept[k]];
    if (problem.is_two_sided(kept[k])) part.two_sided.push_back(static_cast<Index>(k));
  }
  return part;
}

}  // namespace

TEST_CASE("the answer of the whole is put together from its islands, and is that of the whole") {
  for (Difficulty difficulty : {Difficulty::none, Difficulty::repeated_rows, Difficulty::at_rest,
                                Difficulty::two_sided_rows, Difficulty::sparse_rows})
    for (unsigned seed = 1; seed <= 25; ++seed)
      for (bool sparse : {false, true}) {
        CAPTURE(seed);
        CAPTURE(static_cast<int>(difficulty));
        const Archipelago sea = archipelago(seed, 1 + seed % 6, difficulty, sparse);
        const Solution parts = convex::automatic(sea.problem);
        convex::Accuracy full;
        full.reduce = false;
        const Solution whole = convex::automatic(sea.problem, full);
        const double unit =
            std::max({1e-300, sea.problem.A.norm(sea.solution), sea.problem.A.dual_norm(sea.problem.z)});
        REQUIRE(parts.status == Status::solved);
        REQUIRE(whole.status == Status::solved);
        CHECK(sea.problem.A.norm(parts.q - sea.solution) <= few_roundings * unit);
        CHECK(sea.problem.A.norm(parts.q - whole.q) <= few_roundings * unit);
        CHECK(parts.residuals.stationarity <= few_roundings);
        CHECK(parts.residuals.feasibility <= few_roundings);
        Index coordinates = 0, rows = 0;
        for (const convex::Island& island : parts.model.islands) {
          coordinates += island.coordinates;
          rows += island.rows;
        }
        CHECK(coordinates == sea.problem.dimension());
        CHECK(rows <= sea.problem.rows());
        CHECK(whole.model.islands.size() == 1);
      }
}

TEST_CASE("deleting the rows that were left out changes no byte of the answer") {
  Index deleted = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    Archipelago sea = archipelago(seed, 1 + seed % 4, Difficulty::none, seed % 2 == 0);
    if (seed % 3 == 0) {  // 0 admissible, some rows far away
      for (Index a = 0; a < sea.problem.rows(); ++a) sea.problem.s[a] = a % 2 == 0 ? 0.0 : -1000.0;
    }
    const Solution all = convex::automatic(sea.problem);
    const NearestPointProblem part = without(sea.problem, all.model.left_out);
    const Solution fewer = convex::automatic(part);
    CAPTURE(seed);
    deleted += sea.problem.rows() - part.rows();
    CHECK(all.q == fewer.q);
    std::vector<double> loaded, loaded_fewer;
    for (double x : all.lambda)
      if (x > 0) loaded.push_back(x);
    for (double x : fewer.lambda)
      if (x > 0) loaded_fewer.push_back(x);
    CHECK(loaded == loaded_fewer);
    for (const convex::LeftOutRow& out : all.model.left_out) {
      CHECK(all.lambda[out.row] == 0);
      CHECK(all.slack[out.row] >= 0);
    }
  }
  CHECK(deleted > 50);
}

TEST_CASE(
    "a row of zeros is left out when it asks for nothing and is the witness when it asks for something") {
  RowMatrix U(2, 2);
  U << 0, 0, 1, 0;
  NearestPointProblem problem{
      Metric::identity(2), Vector::Constant(2, -1.0), convex::ConstraintRows(U), Vector::Zero(2), {}};
  problem.s[0] = -1;
  const Solution found = convex::automatic(problem);
  CHECK(found.status == Status::solved);
  REQUIRE(found.model.left_out.size() == 1);
  CHECK(found.model.left_out[0].row == 0);
  CHECK(found.model.left_out[0].why == LeftOutBecause::no_gradient);
  CHECK(found.q == Vector(Eigen::Vector2d(0, -1)));
  problem.s[0] = 1;
  const Solution refused = convex::automatic(problem);
  REQUIRE(refused.status == Status::infeasible);
  CHECK(convex::proves_infeasibility(problem, refused.farkas, 1e3));
}

TEST_CASE("one island without a solution makes the whole infeasible, with a witness for the whole") {
  RowMatrix U = RowMatrix::Zero(4, 4);
  U(0, 0) = 1;
  U(1, 2) = 1;
  U(2, 2) = -2;
  U(3, 3) = 1;
  Vector s(4);
  s << 1, 1, 2, 0;
  const NearestPointProblem problem{Metric::identity(4), Vector::Zero(4), convex::ConstraintRows(U), s, {}};
  const Solution found = convex::automatic(problem);
  REQUIRE(found.status == Status::infeasible);
  CHECK(convex::proves_infeasibility(problem, found.farkas, 1e3));
}

TEST_CASE("one contact is solved by its formula, free coordinates are one island") {
  Vector mass(4), z(4);
  mass << 1, 3, 7, 2;
  z << -1, 5, -3, 0.5;
  RowMatrix U = RowMatrix::Zero(1, 4);
  U(0, 0) = 1;
  U(0, 2) = 2;
  const NearestPointProblem problem{
      Metric::diagonal(mass), z, convex::ConstraintRows(U), Vector::Zero(1), {}};
  const Solution found = convex::automatic(problem);
  REQUIRE(found.model.islands.size() == 2);
  CHECK(found.model.islands[0].method == "closed-form");
  CHECK(found.model.islands[0].coordinates == 2);
  CHECK(found.model.islands[1].method == "unconstrained");
  CHECK(found.model.islands[1].first_coordinate == 1);
  // lambda (1/1 + 4/7) = 1 + 6/7.
  CHECK(found.lambda[0] == doctest::Approx(13.0 / 11).epsilon(1e-15));
  CHECK(std::abs(found.q[0] + 2 * found.q[2]) <= 1e-15);
}

TEST_CASE("a warm start that names no row is refused, not followed") {
  const auto sea = convex::gallery_instance(*convex::find_family("well-posed"), 9, 0.5);
  for (const Index row : {Index{-1}, sea.problem.rows(), Index{1} << 40})
    CHECK_THROWS_AS(convex::automatic(sea.problem, {}, {0, row}), convex::InvalidInput);
  const Solution cold = convex::automatic(sea.problem),
                 twice = convex::automatic(sea.problem, {}, {1, 0, 1, 1});
  CHECK(twice.q == cold.q);
}

TEST_CASE("a warm start from the active rows, or from wrong ones, ends at the same answer") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Archipelago sea = archipelago(seed, 3, Difficulty::none, false);
    const Solution cold = convex::automatic(sea.problem);
    const Solution warm = convex::automatic(sea.problem, {}, cold.basis);
    std::vector<Index> all;
    for (Index a = 0; a < sea.problem.rows(); ++a) all.push_back(a);
    const Solution wrong = convex::automatic(sea.problem, {}, all);
    const double unit = std::max(1.0, sea.problem.A.norm(cold.q));
    CHECK(sea.problem.A.norm(warm.q - cold.q) <= few_roundings * unit);
    CHECK(sea.problem.A.norm(wrong.q - cold.q) <= few_roundings * unit);
  }
}
