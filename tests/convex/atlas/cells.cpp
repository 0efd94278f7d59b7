#include <doctest/doctest.h>

#include <algorithm>

#include "convex/atlas/atlas.hpp"
#include "convex/exact/elimination.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"
#include "tests/convex/atlas/atlas_problems.hpp"

using namespace convex;
using namespace convex::atlas;

namespace {

std::vector<std::size_t> rows_of_answer(ExactProblem problem, const ExactVector& z) {
  // z / denominator: the whole over the common denominator.
  for (IntegerVector& row : problem.A)
    for (Integer& number : row) number *= z.denominator;
  problem.z = z.numerators;
  for (Integer& number : problem.z) number *= problem.unit;
  problem.unit *= z.denominator;
  const ExactSolution solution = exact_active_set(problem, {});
  std::vector<std::size_t> tight;
  for (std::size_t a = 0; a < solution.slack.size(); ++a)
    if (sign(solution.slack[a]) == 0) tight.push_back(a);
  return tight;
}

ExactVector random_point(std::mt19937& random, Index n, int size, int denominator) {
  std::uniform_int_distribution<int> entry(-size, size);
  ExactVector z{{}, denominator};
  for (Index i = 0; i < n; ++i) z.numerators.emplace_back(entry(random));
  return z;
}

}  // namespace

TEST_CASE("at any z the rows of its cell are those that the answer there has equality in") {
  std::mt19937 random(3);
  for (const ExactProblem& problem : tests::atlas_problems()) {
    const Atlas whole = convex::atlas::atlas(problem);
    std::vector<bool> met(whole.cells.size(), false);
    for (int k = 0; k < 300; ++k) {
      // Points of a coarse grid often lie on walls, then the tightest of their cells has the rows.
      const ExactVector z =
          random_point(random, problem.dimension(), k % 2 == 0 ? 6 : 90, k % 2 == 0 ? 1 : 7);
      const std::vector<std::size_t> found = cells_at(whole, z);
      REQUIRE(!found.empty());
      const std::vector<std::size_t> rows = rows_of_answer(problem, z);
      const bool one_of_them =
          std::any_of(found.begin(), found.end(), [&](std::size_t c) { return whole.cells[c].rows == rows; });
      CHECK(one_of_them);
      if (found.size() == 1) met[found.front()] = true;
    }
    CHECK(std::count(met.begin(), met.end(), true) >= 1);
  }
}

TEST_CASE("an orthant in n dimensions has 2^n cells, each with n walls") {
  for (int n = 1; n <= 5; ++n) {
    std::vector<std::vector<int>> identity(static_cast<std::size_t>(n),
                                           std::vector<int>(static_cast<std::size_t>(n), 0));
    for (std::size_t i = 0; i < identity.size(); ++i) identity[i][i] = 1;
    const Atlas whole = convex::atlas::atlas(
        tests::atlas_problem(identity, identity, std::vector<int>(static_cast<std::size_t>(n), 0)));
    CHECK(whole.cells.size() == std::size_t{1} << static_cast<unsigned>(n));
    CHECK(whole.is_conical);
    for (const Cell& cell : whole.cells) {
      CHECK(cell.walls.size() == static_cast<std::size_t>(n));
      CHECK(cell.freedom + static_cast<Index>(cell.rows.size()) == n);
    }
  }
}

TEST_CASE(
    "a wall is where the slack of the looser cell's answer, or the multiplier of the tighter one's, is 0") {
  for (const ExactProblem& problem : tests::atlas_problems()) {
    const Atlas whole = convex::atlas::atlas(problem);
    std::mt19937 random(5);
    for (const Wall& wall : whole.walls) {
      const Cell &tighter = whole.cells[wall.tighter], &looser = whole.cells[wall.looser];
      CHECK(std::includes(tighter.rows.begin(), tighter.rows.end(), looser.rows.begin(), looser.rows.end()));
      CHECK(tighter.freedom + 1 == looser.freedom);
      // Any z moved onto the wall's plane along A normal, the shortest way in A⁻¹, has both answers in
      // common: q of the looser equations has equality in the tighter rows.
      const ExactVector z = random_point(random, problem.dimension(), 50, 3);
      const Fraction off = side(wall, z) / wall.squared_length;
      std::vector<Fraction> moved;
      for (std::size_t i = 0; i < z.numerators.size(); ++i)
        moved.push_back(entry(z, i) - off * Fraction{dot(problem.A[i], wall.normal), problem.unit});
      const ExactVector on = exact_vector(moved);
      CHECK(sign(side(wall, on)) == 0);
      // Of the looser equations alone.
      ExactProblem alone = problem;
      alone.U.clear();
      alone.s.clear();
      alone.row_unit.clear();
      alone.two_sided.clear();
      for (const std::size_t a : looser.rows) {
        alone.U.push_back(problem.U[a]);
        alone.s.push_back(problem.s[a]);
        alone.row_unit.push_back(problem.row_unit[a]);
        alone.two_sided.push_back(static_cast<Index>(alone.U.size()) - 1);
      }
      for (IntegerVector& row : alone.A)
        for (Integer& number : row) number *= on.denominator;
      alone.z = on.numerators;
      for (Integer& number : alone.z) number *= alone.unit;
      alone.unit *= on.denominator;
      const ExactSolution answer = exact_active_set(alone, {});
      for (const std::size_t a : tighter.rows)
        CHECK(lowest_terms({dot(problem.U[a], answer.q.numerators), answer.q.denominator}) ==
              Fraction{problem.s[a], 1});
    }
  }
}

TEST_CASE("rows that exclude each other leave no cell") {
  CHECK(convex::atlas::atlas(tests::atlas_problem({{1}}, {{1}, {-1}}, {1, 0})).cells.empty());
}

TEST_CASE("explored from wall to wall, an atlas has the cells and walls that the faces give it") {
  for (const ExactProblem& problem : tests::atlas_problems()) {
    const Atlas whole = convex::atlas::atlas(problem), found = explored(problem, 10000);
    CHECK(found.is_complete());
    CHECK(found.cells.size() == whole.cells.size());
    CHECK(found.walls.size() == whole.walls.size());
    for (const Wall& wall : found.walls) {
      const auto same = std::find_if(whole.walls.begin(), whole.walls.end(), [&](const Wall& other) {
        return whole.cells[other.tighter].rows == found.cells[wall.tighter].rows &&
               whole.cells[other.looser].rows == found.cells[wall.looser].rows;
      });
      REQUIRE(same != whole.walls.end());
      CHECK(same->normal == wall.normal);
      CHECK(same->offset == wall.offset);
    }
  }
}

TEST_CASE("the first cell explored has all its walls, however many cells there are") {
  std::vector<std::vector<int>> identity(20, std::vector<int>(20, 0));
  for (std::size_t i = 0; i < 20; ++i) identity[i][i] = 1;
  const Atlas near = explored(tests::atlas_problem(identity, identity, std::vector<int>(20, 0)), 1);
  CHECK(near.explored == 1);
  CHECK(near.cells.size() == 21);
  CHECK(near.cells[0].walls.size() == 20);
  CHECK_FALSE(near.is_complete());
}
