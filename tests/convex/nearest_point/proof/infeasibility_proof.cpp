#include "convex/nearest_point/proof/infeasibility_proof.hpp"

#include <doctest/doctest.h>

#include <random>

#include "convex/nearest_point/automatic.hpp"
#include "tests/oracles/rational_text.hpp"

using convex::ConstraintRows;
using convex::Index;
using convex::InfeasibilityProof;
using convex::NearestPointProblem;
using convex::ProofLevel;
using convex::RowMatrix;
using convex::Vector;
using oracles::RationalVector;

namespace {

/// k + 1 rows on k coordinates, full mantissas, whose positive combination w cancels up to rounding and
/// leaves w·s = gap.
NearestPointProblem simplex_of_rows(unsigned seed, Index k, double gap, Vector& w) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  RowMatrix U(k + 1, k);
  for (Index i = 0; i < U.size(); ++i) U.data()[i] = normal(generator);
  w.resize(k + 1);
  for (Index a = 0; a <= k; ++a) w[a] = 1 + std::abs(normal(generator));
  U.row(k) = -(w.head(k).transpose() * U.topRows(k)) / w[k];
  Vector s(k + 1);
  for (Index a = 0; a <= k; ++a) s[a] = normal(generator);
  s[0] += (gap - w.dot(s)) / w[0];
  return {convex::Metric::identity(k), Vector::Zero(k), ConstraintRows(U), s, {}};
}

RationalVector rationals(const convex::IntegerVector& w) { return oracles::rationals({w, 1}); }

}  // namespace

TEST_CASE("weights of full-mantissa rows that cancel to rounding are made exact") {
  for (const Index k : {1, 3, 20}) {
    Vector w;
    const NearestPointProblem problem = simplex_of_rows(5, k, 1e-3, w);
    const auto proof = convex::infeasibility_proof(problem, w);
    REQUIRE(proof);
    CHECK(proof->level == ProofLevel::exact);
    CHECK(oracles::is_exact_farkas_witness(problem, rationals(proof->weights)));
    CHECK(oracles::is_farkas_witness(problem, proof->farkas, 1e-12));
  }
}

TEST_CASE(
    "many rows are proved to contradict each other in doubles, and by a margin below rounding they are not") {
  Vector w;
  const NearestPointProblem problem = simplex_of_rows(7, convex::most_exact_rows + 20, 1e-3, w);
  const auto proof = convex::infeasibility_proof(problem, w);
  REQUIRE(proof);
  CHECK(proof->level == ProofLevel::enclosure);
  CHECK(oracles::is_farkas_witness(problem, proof->farkas, 1e-12));
  const NearestPointProblem narrow = simplex_of_rows(7, convex::most_exact_rows + 20, 1e-15, w);
  CHECK_FALSE(convex::infeasibility_proof(narrow, w));
}

TEST_CASE("weights that prove nothing are not proved: rows that agree, and rows that do not depend") {
  Vector w;
  const NearestPointProblem feasible = simplex_of_rows(9, 6, -1e-3, w);
  CHECK_FALSE(convex::infeasibility_proof(feasible, w));
  NearestPointProblem independent = simplex_of_rows(9, 6, 1, w);
  w[6] = 0;
  CHECK_FALSE(convex::infeasibility_proof(independent, w));
  CHECK_FALSE(convex::infeasibility_proof(independent, Vector::Zero(7)));
}

TEST_CASE("three rows among ten thousand are all that is looked at; two-sided weights may be negative") {
  constexpr int n = 10000;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  entries.emplace_back(n, 7, -0.1);
  entries.emplace_back(n, 4321, 0.3);
  entries.emplace_back(n + 1, 4321, 0.7);
  convex::SparseRows U(n + 2, n);
  U.setFromTriplets(entries.begin(), entries.end());
  Vector s = Vector::Constant(n + 2, -1.0);
  s[7] = 1;        // q_7 >= 1
  s[n] = 0.2;      // 0.3 q_4321 >= 0.2 + 0.1 q_7
  s[n + 1] = 0.5;  // 0.7 q_4321 = 0.5
  const NearestPointProblem problem{
      convex::Metric::identity(n), Vector::Zero(n), ConstraintRows(U), s, {n + 1}};
  Vector w = Vector::Zero(n + 2);
  w[7] = 0.1;
  w[n] = 1;
  w[n + 1] = -3.0 / 7;
  const auto proof = convex::infeasibility_proof(problem, w);
  REQUIRE(proof);
  CHECK(oracles::is_exact_farkas_witness(problem, rationals(proof->weights)));
}

TEST_CASE("weights of rows that contradict each other by an ulp are rounded so that they still do") {
  const auto told = [](const RowMatrix& U, const Vector& s, std::vector<Index> two_sided) {
    const NearestPointProblem problem{convex::Metric::identity(U.cols()), Vector::Zero(U.cols()),
                                      ConstraintRows(U), s, std::move(two_sided)};
    const convex::Solution found = convex::automatic(problem);
    REQUIRE(found.status == convex::Status::infeasible);
    CHECK(found.farkas.allFinite());
    CHECK(oracles::is_farkas_witness(problem, found.farkas, 1e-12));
  };
  // Six times 2/3 and 1/3, to the last digit, beside 4 and 2: the weights 1 and 6 leave 0 >= 0.
  told(RowMatrix{{4, 2}, {-0.6666666666666666, -0.3333333333333333}}, Vector{{-6, 1}}, {});
  told(RowMatrix{{-0.22661962356896645, -0.6596340768190186},
                 {-0.7850791524439731, -0.09612114149927709},
                 {-1.0116987760129394, -0.7557552783182957}},
       Vector{{0, 0.07846274809691922, 0.07846274809691922}}, {0, 1});
  // The smallest weight is 2^1074 times below the largest.
  told(RowMatrix{{0, 1, 0}, {0, -0.5, 5e-324}, {1, 0, -2}, {-1, 0, 0}}, Vector{{2, 0, 1, 0}}, {});
}
