#include <doctest/doctest.h>

#include <vector>

#include "convex/exact/fraction_arithmetic.hpp"
#include "convex/nearest_point/automatic.hpp"

using convex::Index;
using convex::Metric;
using convex::NearestPointProblem;
using convex::Solution;
using convex::SparseMatrix;
using convex::SparseRows;
using convex::Status;
using convex::Vector;

namespace {

/// 1.37 q_0 >= s_0 and -1.63 q_0 >= s_1, which meet near 0.7, on the first of n coupled coordinates, and rows
/// that the answer is clear of.
NearestPointProblem two_among_many(Index n, double from_below, double from_above) {
  std::vector<Eigen::Triplet<double>> A, U;
  for (Index i = 0; i < n; ++i) {
    const int k = static_cast<int>(i);
    A.emplace_back(k, k, 3);
    if (i > 0) A.emplace_back(k, k - 1, -1), A.emplace_back(k - 1, k, -1);
  }
  const Index others = n / 2;
  Vector s = Vector::Constant(others + 2, -1);
  s[0] = from_below;
  s[1] = from_above;
  U.emplace_back(0, 0, 1.37);
  U.emplace_back(1, 0, -1.63);
  for (int a = 0; a < static_cast<int>(others); ++a)
    U.emplace_back(a + 2, (37 * a + 11) % static_cast<int>(n), 1.0);
  SparseMatrix W(n, n);
  W.setFromTriplets(A.begin(), A.end());
  SparseRows rows(s.size(), n);
  rows.setFromTriplets(U.begin(), U.end());
  return {Metric::sparse(W), Vector::Ones(n), convex::ConstraintRows(rows), s, {}};
}

}  // namespace

TEST_CASE("rows that exclude each other by rounding are told though fractions may not look at all others") {
  const double below = 1.37 * 0.7, above = -1.63 * 0.7;
  // In fractions 1.63 times the one and 1.37 times the other leave 0 >= something positive, or negative.
  const auto left = [&](double s) {
    return (convex::fraction(1.63) * convex::fraction(below) + convex::fraction(1.37) * convex::fraction(s))
        .numerator.sign();
  };
  const double kept = above - 0x1p-51;
  REQUIRE(left(above) > 0);
  REQUIRE(left(kept) < 0);
  for (const Index n : {300, 500})
    for (const double limit : {1.0, 1e-9}) {
      CAPTURE(n);
      CAPTURE(limit);
      const Solution found = convex::automatic(two_among_many(n, below, above), {.limit = limit});
      CHECK(found.status == Status::infeasible);
      REQUIRE(found.farkas.size() == n / 2 + 2);
      CHECK(found.farkas[0] > 0);
      CHECK(found.farkas[1] > 0);
      CHECK(found.farkas.tail(n / 2).isZero(0));
      CHECK(convex::automatic(two_among_many(n, below, kept), {.limit = limit}).status != Status::infeasible);
    }
}
