#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/active_set/active_set.hpp"
#include "convex/nearest_point/automatic.hpp"
#include "convex/nearest_point/isotonic/bordered_chain.hpp"
#include "convex/nearest_point/isotonic/chain.hpp"

using convex::ConstraintRows;
using convex::Index;
using convex::Metric;
using convex::NearestPointProblem;
using convex::Solution;
using convex::SparseRows;
using convex::Status;
using convex::Vector;

namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

/// A string of n bodies that pushes together, with `spoilers` rows among its links, which `spoil` writes; s =
/// 0 on the string, small on the others.
template <class Spoil>
NearestPointProblem spoiled_string(Index n, Index spoilers, unsigned seed, Spoil spoil) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Vector mass(n), z(n), s = Vector::Zero(n - 1 + spoilers);
  for (Index i = 0; i < n; ++i) {
    mass[i] = std::exp(2 * normal(generator));
    z[i] = mass[i] * normal(generator);
  }
  Entries entries;
  for (Index i = 0; i + 1 < n; ++i) {
    entries.emplace_back(i, i, -1.0);
    entries.emplace_back(i, i + 1, 1.0);
    if (seed % 2 == 0) s[i] = 0.1 * normal(generator);
  }
  NearestPointProblem problem{Metric::diagonal(mass), z, ConstraintRows(), s, {}};
  for (Index k = 0; k < spoilers; ++k) spoil(n - 1 + k, generator, entries, problem);
  SparseRows U(n - 1 + spoilers, n);
  U.setFromTriplets(entries.begin(), entries.end());
  problem.U = ConstraintRows(U);
  return problem;
}

Index drawn(Index n, std::mt19937& generator) {
  return static_cast<Index>(generator() % static_cast<unsigned>(n));
}

void check_against_the_general_method(const NearestPointProblem& problem) {
  const std::optional<Solution> found = convex::solve_bordered_chain(problem);
  REQUIRE(found.has_value());
  CHECK(found->status == Status::solved);
  CHECK(found->method == "bordered-chain");
  const Solution general = convex::active_set(problem);
  REQUIRE(general.status == Status::solved);
  const double scale = std::max(problem.A.norm(general.q), problem.A.dual_norm(problem.z));
  CHECK(problem.A.norm(found->q - general.q) <= 4e-15 * scale);
  CHECK(found->residuals.feasibility <= 4e-15);
  CHECK(found->residuals.complementarity <= 4e-15);
  CHECK(found->residuals.stationarity <= 1e-13);  // multipliers are rounded
  for (Index a = 0; a < problem.rows(); ++a)
    if (!problem.is_two_sided(a)) CHECK(found->lambda[a] >= 0);
}

}  // namespace

TEST_CASE("links of other factors, rings, ceilings and rigid links are a border that the strings bear") {
  for (unsigned seed = 0; seed < 24; ++seed) {
    CAPTURE(seed);
    const Index n = 100;
    check_against_the_general_method(spoiled_string(
        n, 1 + seed % 3, seed, [&](Index a, std::mt19937& generator, Entries& e, auto& problem) {
          const int row = static_cast<int>(a);
          const int i = static_cast<int>(drawn(n - 3, generator)),
                    j = i + 1 + static_cast<int>(drawn(2, generator));
          switch (generator() % 5) {
            case 0:  // another factor
              e.emplace_back(row, i, -1.0);
              e.emplace_back(row, j, 1.7);
              break;
            case 1:  // further apart than the links ask for
              e.emplace_back(row, i, -1.0);
              e.emplace_back(row, j, 1.0);
              problem.s[a] = 0.5;
              break;
            case 2:  // a ceiling
              e.emplace_back(row, j, -2.0);
              problem.s[a] = -0.1;
              break;
            case 3:  // rigid
              e.emplace_back(row, i, -1.0);
              e.emplace_back(row, j, 1.0);
              problem.s[a] = 0.25;
              problem.two_sided.push_back(a);
              break;
            default:  // not too far from the first
              e.emplace_back(row, 0, 1.0);
              e.emplace_back(row, j, -1.0);
              problem.s[a] = -2 - 0.1 * j;
          }
        }));
  }
}

TEST_CASE("a border of rows that touch all coordinates is met to all digits") {
  for (unsigned seed = 0; seed < 6; ++seed)
    check_against_the_general_method(
        spoiled_string(120, 2, seed, [&](Index a, std::mt19937& generator, Entries& e, auto& problem) {
          std::normal_distribution<double> normal;
          for (int i = 0; i < 120; ++i) e.emplace_back(static_cast<int>(a), i, 0.1 * normal(generator));
          problem.s[a] = 3;
        }));
}

TEST_CASE("a spoiled string of ten thousand keeps to pooling, a border that contradicts it does not settle") {
  const auto doubled = [](Index a, std::mt19937&, Entries& e, auto&) {
    e.emplace_back(static_cast<int>(a), 5000, -1.0);
    e.emplace_back(static_cast<int>(a), 5001, 2.0);
  };
  const NearestPointProblem problem = spoiled_string(10000, 1, 1, doubled);
  const Solution found = convex::automatic(problem);
  CHECK(found.status == Status::solved);
  CHECK(found.method == "bordered-chain");
  CHECK(found.error_bound <= 1e-12 * problem.A.norm(found.q));
  const NearestPointProblem contradicted =
      spoiled_string(60, 1, 1, [](Index a, std::mt19937&, Entries& e, auto& whole) {
        e.emplace_back(static_cast<int>(a), 10, 1.0);
        e.emplace_back(static_cast<int>(a), 40, -1.0);
        whole.s[a] = 1;  // q_10 - q_40 >= 1 with q rising
      });
  CHECK_FALSE(convex::solve_bordered_chain(contradicted).has_value());
  CHECK(convex::automatic(contradicted).status == Status::infeasible);
}

TEST_CASE("means that differ by less than a rounding are told apart by sums in twice the precision") {
  std::mt19937 generator(11);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    const Index n = 40;
    Vector mass(n), z(n);
    for (Index i = 0; i < n; ++i) {
      mass[i] = std::exp(3 * normal(generator));
      z[i] = mass[i] / 3 * (trial % 2 == 0 ? 1 : 1e-8) + (i % 9 == 0 ? 0x1p-50 * normal(generator) : 0);
    }
    Entries entries;
    for (int i = 0; i + 1 < n; ++i) {
      entries.emplace_back(i, i, -1.0);
      entries.emplace_back(i, i + 1, 1.0);
    }
    SparseRows U(n - 1, n);
    U.setFromTriplets(entries.begin(), entries.end());
    const NearestPointProblem problem{Metric::diagonal(mass), z, ConstraintRows(U), Vector::Zero(n - 1), {}};
    const std::optional<Solution> found = convex::solve_chain(problem);
    REQUIRE(found.has_value());
    // The multipliers follow from the forces alone: exact sums of z - Aq, whose signs prove the pools.
    std::vector<long double> q(static_cast<std::size_t>(n));
    long double push = 0, weight = 0, sum = 0;
    for (Index i = 0; i < n; ++i) {  // pools as the multipliers show them
      weight += static_cast<long double>(mass[i]);
      sum += static_cast<long double>(z[i]);
      push = sum;
      if (i + 1 < n && found->lambda[i] > 0) continue;
      CHECK(static_cast<double>(push / weight) == doctest::Approx(found->q[i]).epsilon(1e-15));
      weight = sum = 0;
    }
    for (Index i = 0; i + 1 < n; ++i) CHECK(found->q[i + 1] >= found->q[i]);
    CHECK(found->residuals.stationarity <= 1e-15);
  }
}

TEST_CASE("what was left out can be deleted, and the bytes stay") {
  // Two strings apart, the second never touched by its links; rows out of reach of the first.
  const NearestPointProblem whole =
      spoiled_string(80, 2, 4, [](Index a, std::mt19937&, Entries& e, auto& problem) {
        e.emplace_back(static_cast<int>(a), static_cast<int>(a) - 70, 1.0);
        problem.s[a] = -1e6;
      });
  NearestPointProblem shifted = whole;
  for (Index a = 0; a < 79; ++a) shifted.s[a] = std::min(shifted.s[a], 0.0);
  const Solution found = convex::automatic(shifted);
  REQUIRE(found.status == Status::solved);
  REQUIRE_FALSE(found.model.left_out.empty());
  std::vector<Index> kept;
  for (Index a = 0, out = 0; a < shifted.rows(); ++a)
    if (out < static_cast<Index>(found.model.left_out.size()) &&
        found.model.left_out[static_cast<std::size_t>(out)].row == a)
      ++out;
    else
      kept.push_back(a);
  NearestPointProblem rest{
      shifted.A, shifted.z, shifted.U.select(kept), Vector(static_cast<Index>(kept.size())), {}};
  for (std::size_t k = 0; k < kept.size(); ++k) rest.s[static_cast<Index>(k)] = shifted.s[kept[k]];
  const Solution again = convex::automatic(rest);
  CHECK(again.q == found.q);
  for (std::size_t k = 0; k < kept.size(); ++k)
    CHECK(again.lambda[static_cast<Index>(k)] == found.lambda[kept[k]]);
}

TEST_CASE("a first row that ties the ends of a string is no floor under it") {
  std::mt19937 generator(46);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 400; ++k) {
    const Index n = 2 + drawn(12, generator), end = 1 + drawn(n - 1, generator);
    const double factor = k % 2 == 0 ? 1 : 3;
    Entries entries{{0, 0, factor}};  // q_0 - q_end >= s_0: at most so far apart
    entries.emplace_back(0, end, -factor);
    Vector z(n), s = Vector::Zero(n);
    s[0] = k % 3 == 0 ? 0 : -std::abs(normal(generator));
    for (Index i = 0; i < n; ++i) z[i] = normal(generator);
    for (Index i = 1; i < n; ++i) {
      entries.emplace_back(i, i - 1, -1.0);
      entries.emplace_back(i, i, 1.0);
    }
    SparseRows U(n, n);
    U.setFromTriplets(entries.begin(), entries.end());
    const Solution found = convex::automatic({Metric::identity(n), z, ConstraintRows(U), s, {}});
    const Solution dense =
        convex::active_set({Metric::identity(n), z, ConstraintRows(convex::RowMatrix(U)), s, {}});
    CHECK(found.status == Status::solved);
    CHECK((found.q - dense.q).norm() <= 1e-12 * z.norm());
  }
  SparseRows U(2, 2);
  const Entries apart{{0, 0, 1.0}, {0, 1, -1.0}, {1, 0, -1.0}, {1, 1, 1.0}};
  U.setFromTriplets(apart.begin(), apart.end());
  CHECK(convex::automatic({Metric::identity(2), Vector::Zero(2), ConstraintRows(U), Vector{{1, 0}}, {}})
            .status == Status::infeasible);
}
