#include "convex/atlas/dropping_rule.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "convex/atlas/plane_map.hpp"
#include "convex/nearest_point/proof/exact_solution.hpp"
#include "tests/convex/atlas/atlas_problems.hpp"

using namespace convex;
using namespace convex::atlas;

namespace {

/// The problem at z, whole numbers, with these rows alone, two-sided.
ExactSolution held(const ExactProblem& problem, const IntegerVector& z,
                   const std::vector<std::size_t>& rows) {
  ExactProblem only = problem;
  only.z = z;
  for (Integer& entry : only.z) entry *= only.unit;
  only.U.clear();
  only.s.clear();
  only.row_unit.clear();
  only.two_sided.clear();
  for (const std::size_t a : rows) {
    only.two_sided.push_back(static_cast<Index>(only.U.size()));
    only.U.push_back(problem.U[a]);
    only.s.push_back(problem.s[a]);
    only.row_unit.push_back(problem.row_unit[a]);
  }
  return exact_active_set(only, {});
}

/// By the rule itself: hold all, drop the negative, compare the acceleration with the true one.
bool rule_is_right(const ExactProblem& problem, const IntegerVector& z) {
  std::vector<std::size_t> all, kept;
  for (std::size_t a = 0; a < problem.U.size(); ++a) all.push_back(a);
  const ExactSolution two_sided = held(problem, z, all);
  for (const std::size_t a : all)
    if (two_sided.lambda.numerators[a].sign() >= 0) kept.push_back(a);
  ExactProblem here = problem;
  here.z = z;
  for (Integer& entry : here.z) entry *= here.unit;
  const ExactVector truth = exact_active_set(here, {}).q, by_rule = held(problem, z, kept).q;
  for (std::size_t i = 0; i < truth.numerators.size(); ++i)
    if (!(entry(truth, i) == entry(by_rule, i))) return false;
  return true;
}

}  // namespace

TEST_CASE("the rule is right on a cell exactly where its part says so") {
  std::mt19937 random(11);
  std::uniform_int_distribution<int> number(-40, 40);
  int right = 0, wrong = 0;
  for (const ExactProblem& problem : {tests::atlas_problem({{2, 1}, {1, 2}}, {{1, 0}, {0, 1}}, {0, 0}),
                                      tests::atlas_problem({{2, 1}, {1, 1}}, {{1, 0}, {1, 1}}, {1, -2}),
                                      tests::atlas_problem({{3, 1, 1}, {1, 2, 1}, {1, 1, 4}},
                                                           {{1, 2, 0}, {0, 1, -3}, {1, 1, 1}}, {0, 1, -1})}) {
    const Atlas whole = convex::atlas::atlas(problem);
    REQUIRE(rule_is_defined(whole));
    for (int k = 0; k < 400; ++k) {
      IntegerVector z;
      for (Index i = 0; i < problem.dimension(); ++i) z.emplace_back(number(random));
      const std::vector<std::size_t> cells = cells_at(whole, {z, 1});
      if (cells.size() > 1 || whole.cells[cells[0]].rows.size() == problem.U.size()) continue;
      IntegerVector free;
      Integer unit = whole.space.factor.denominator;
      for (const IntegerVector& row : whole.space.free_rows) {
        Integer sum = 0;
        for (std::size_t i = 0; i < z.size(); ++i) sum += row[i] * z[i];
        free.push_back(sum * whole.space.factor.numerator);
      }
      free.push_back(unit);
      bool within = true, on_edge = false;
      for (const IntegerVector& form : kept_by_rule(whole, cells[0])) {
        Integer value = 0;
        for (std::size_t i = 0; i < form.size(); ++i) value += form[i] * free[i];
        within = within && value.sign() >= 0;
        on_edge = on_edge || value.is_zero();
      }
      if (on_edge) continue;
      CHECK(within == rule_is_right(problem, z));
      (within ? right : wrong) += 1;
    }
  }
  CHECK(right > 50);
  CHECK(wrong > 50);
}

TEST_CASE("accepted, right and wrong have the whole probability together") {
  const Atlas whole = convex::atlas::atlas(tests::atlas_problem(
      {{3, 1, 1}, {1, 2, 1}, {1, 1, 4}}, {{1, 2, 0}, {0, 1, -3}, {1, 1, 1}}, {0, 0, 0}, {2}));
  const CellProbability probability(whole.space, {{IntegerVector(3, 0), 1}});
  std::vector<Probability> cells;
  for (const Cell& cell : whole.cells) cells.push_back(probability.of(cell, 1e-6));
  const RuleVerdict verdict = judge_rule(whole, probability, cells, 1e-6);
  CHECK(std::abs(verdict.accepted.value + verdict.right.value + verdict.wrong.value - 1) <= 1e-12);
  CHECK(verdict.wrong.value > 0.01);
  CHECK(verdict.right.value > 0.01);
}

TEST_CASE("a plane that lies in a wall belongs to the cell in which more rows hold, once") {
  const Atlas whole = convex::atlas::atlas(tests::atlas_problem({{1, 0}, {0, 1}}, {{1, 0}, {0, 1}}, {0, 0}));
  const Parameters along{{{0, 0}, 1}, {{{0, 1}, 1}}, {{-1, 1}}, {{3, 1}}};
  const std::vector<PlaneRegion> regions = plane_map(whole, along);
  REQUIRE(regions.size() == 2);
  CHECK(regions[0].polygon.area == Fraction{1, 1});
  CHECK(regions[1].polygon.area == Fraction{3, 1});
  CHECK(whole.cells[regions[1].cell].rows == std::vector<std::size_t>{0});
}
