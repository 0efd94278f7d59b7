#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convex/atlas/cell_probability.hpp"
#include "tests/convex/atlas/atlas_problems.hpp"

using namespace convex;
using namespace convex::atlas;

namespace {

Probability sum_of_cells(const Atlas& whole, const NormalLinearTerm& force, double tolerance) {
  const CellProbability probability(whole.space, force);
  Probability sum;
  for (const Cell& cell : whole.cells) {
    const Probability p = probability.of(cell, tolerance);
    CHECK(p.error <= tolerance);
    CHECK(p.value >= -p.error);
    add(sum, 1, p);
  }
  return sum;
}

ExactVector point(const std::vector<int>& numerators, int denominator) {
  return {IntegerVector(numerators.begin(), numerators.end()), denominator};
}

/// Any, but the same.
NormalLinearTerm oblique_force(Index n, bool with_covariance) {
  std::vector<int> mean;
  for (Index i = 0; i < n; ++i) mean.push_back(static_cast<int>(2 - i));
  NormalLinearTerm force{point(mean, 3)};
  if (!with_covariance) return force;
  std::vector<std::vector<int>> rows(static_cast<std::size_t>(n),
                                     std::vector<int>(static_cast<std::size_t>(n), 1));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i][i] = static_cast<int>(i + 3);
  force.covariance = tests::integer_rows(rows);
  return force;
}

}  // namespace

TEST_CASE("the cells of any atlas have the whole probability together, within the sum of their bounds") {
  for (const ExactProblem& problem : tests::atlas_problems()) {
    const Atlas whole = convex::atlas::atlas(problem);
    const Index n = problem.dimension();
    for (const NormalLinearTerm& force :
         {NormalLinearTerm{{IntegerVector(static_cast<std::size_t>(n), 0), 1}}, oblique_force(n, false),
          oblique_force(n, true)}) {
      const Probability sum = sum_of_cells(whole, force, 1e-6);
      CHECK(std::abs(sum.value - 1) <= sum.error);
    }
  }
}

TEST_CASE("a covariance written out as A gives the probabilities that the product of two factors gives") {
  for (const ExactProblem& problem : tests::atlas_problems()) {
    const Atlas whole = convex::atlas::atlas(problem);
    NormalLinearTerm product = oblique_force(problem.dimension(), false), joint = product;
    ExactRows A;
    for (const IntegerVector& row : problem.A) A.push_back({row, problem.unit});
    joint.covariance = A;
    const CellProbability first(whole.space, product), second(whole.space, joint);
    for (const Cell& cell : whole.cells) {
      const Probability p = first.of(cell, 1e-7), q = second.of(cell, 1e-7);
      CHECK(std::abs(p.value - q.value) <= p.error + q.error);
    }
  }
}

TEST_CASE("each of the 2^n cells of an orthant has the probability 2^-n, exactly up to three dimensions") {
  for (int n = 1; n <= 6; ++n) {
    const auto size = static_cast<std::size_t>(n);
    std::vector<std::vector<int>> identity(size, std::vector<int>(size, 0));
    for (std::size_t i = 0; i < size; ++i) identity[i][i] = 1;
    const Atlas whole =
        convex::atlas::atlas(tests::atlas_problem(identity, identity, std::vector<int>(size, 0)));
    const CellProbability probability(whole.space, {{IntegerVector(size, 0), 1}});
    for (const Cell& cell : whole.cells) {
      const Probability p = probability.of(cell, 1e-6);
      CHECK(p.closed);
      CHECK(std::abs(p.value - std::ldexp(1, -n)) <= 1e-15);
    }
  }
}

TEST_CASE("a wedge of two contacts has angle/2pi for both, and the polar wedge the rest of half a turn") {
  // u = (0, 1) and (a, b): the wedge of points has the angle pi - acos(b/sqrt(a² + b²)).
  for (const auto& [a, b] : {std::pair{1, 1}, {5, -3}, {-7, 2}, {1, -1000000}}) {
    const Atlas whole =
        convex::atlas::atlas(tests::atlas_problem({{1, 0}, {0, 1}}, {{0, 1}, {a, b}}, {0, 0}));
    const CellProbability probability(whole.space, {point({0, 0}, 1)});
    const double between = std::atan2(std::abs(a), b), turn = 2 * std::numbers::pi;
    REQUIRE(whole.cells.size() == 4);
    CHECK(probability.of(whole.cells[0], 1e-6).value == doctest::Approx(between / turn).epsilon(1e-13));
    CHECK(probability.of(whole.cells[1], 1e-6).value == doctest::Approx(0.25).epsilon(1e-14));
    CHECK(probability.of(whole.cells[2], 1e-6).value == doctest::Approx(0.25).epsilon(1e-14));
    CHECK(probability.of(whole.cells[3], 1e-6).value ==
          doctest::Approx((std::numbers::pi - between) / turn).epsilon(1e-9));
  }
}

TEST_CASE("the rays of a cube's faces and corners take the solid angles that geometry gives them") {
  // {|y| <= z, |x| <= z}: the cone over a face of the cube takes a sixth of the space.
  const Atlas whole = convex::atlas::atlas(tests::atlas_problem(
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{1, 0, 1}, {-1, 0, 1}, {0, 1, 1}, {0, -1, 1}}, {0, 0, 0, 0}));
  const CellProbability probability(whole.space, {point({0, 0, 0}, 1)});
  REQUIRE(whole.cells.size() == 10);
  const Probability p = probability.of(whole.cells.back(), 1e-6);
  CHECK(p.closed);
  CHECK(std::abs(p.value - 1.0 / 6) <= p.error);
  // On a facet: half of the plane angle of the face, which is acos(1/3), in a whole turn.
  CHECK(probability.of(whole.cells[5], 1e-6).value ==
        doctest::Approx(std::acos(1.0 / 3) / (4 * std::numbers::pi)).epsilon(1e-14));
}

TEST_CASE("contacts apart from the mean have the products that independent coordinates give") {
  // -1 <= x <= 2 and y >= 1 with A = 1, x about 1/2, y about 1/3.
  const Atlas whole =
      convex::atlas::atlas(tests::atlas_problem({{1, 0}, {0, 1}}, {{1, 0}, {-1, 0}, {0, 1}}, {-1, -2, 1}));
  const CellProbability probability(whole.space, {point({3, 2}, 6)});
  const auto below = [](double bound) { return std::erfc(-bound / std::numbers::sqrt2) / 2; };
  for (const Cell& cell : whole.cells) {
    const auto holds = [&](std::size_t row) {
      return std::find(cell.rows.begin(), cell.rows.end(), row) != cell.rows.end();
    };
    const double left = below(-1 - 0.5), right = 1 - below(2 - 0.5), floor = below(1 - 1.0 / 3);
    const double x = holds(0) ? left : holds(1) ? right : 1 - left - right;
    const Probability p = probability.of(cell, 1e-6);
    CHECK(p.value == doctest::Approx(x * (holds(2) ? floor : 1 - floor)).epsilon(1e-12));
  }
}

TEST_CASE("cells are met as often as their probabilities say, within five standard deviations") {
  constexpr int draws = 3000;
  for (const ExactProblem& problem : tests::atlas_problems()) {
    const Atlas whole = convex::atlas::atlas(problem);
    const Index n = problem.dimension();
    const NormalLinearTerm force = oblique_force(n, true);
    // Covariance 11ᵀ + diag(2, 3, …): one normal number for all, one more for each.
    std::mt19937 random(23);
    std::normal_distribution<double> normal;
    std::vector<int> met(whole.cells.size(), 0);
    for (int k = 0; k < draws; ++k) {
      const double shared = normal(random);
      Vector z = nearest(force.mean);
      for (Index i = 0; i < n; ++i) z[i] += shared + std::sqrt(static_cast<double>(i + 2)) * normal(random);
      ++met[cells_at(whole, exact_vector(z)).front()];
    }
    const CellProbability probability(whole.space, force);
    for (std::size_t c = 0; c < whole.cells.size(); ++c) {
      const double p = probability.of(whole.cells[c], 1e-6).value;
      CHECK(std::abs(met[c] - draws * p) <= 5 * std::sqrt(draws * p * (1 - p)) + 5);
    }
  }
}
