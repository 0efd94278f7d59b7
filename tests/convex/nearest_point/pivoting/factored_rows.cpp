#include "convex/nearest_point/pivoting/factored_rows.hpp"

#include <doctest/doctest.h>

#include "tests/oracles/planted_problem.hpp"

using convex::Arena;
using convex::FactoredRows;
using convex::Index;
using convex::Matrix;
using convex::RowMatrix;
using convex::Vector;

TEST_CASE("the coefficients of sums of the working set come out however many sums are asked for") {
  for (unsigned seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    const Index n = 20 + static_cast<Index>(seed);
    const convex::NearestPointProblem problem =
        oracles::planted_problem(seed, n, 2 * n, oracles::Difficulty::none).problem;
    Arena arena;
    FactoredRows rows(problem, arena);
    REQUIRE(rows.settle({}));
    const convex::GramPoint& point = rows.point();
    const RowMatrix held =
        problem.U.dense()(std::vector<Index>(point.rows, point.rows + point.size), Eigen::all);
    REQUIRE(point.size > 1);
    const Matrix expected = Matrix::NullaryExpr(8, point.size, [&](Index l, Index k) {
      return static_cast<double>((3 * l + 5 * k + l * k) % 7 - 3);
    });
    Eigen::Map<Matrix>(point.pack, 8, n) = expected * held;
    for (Index in_all : {Index{1}, n + 1, Index{1}}) {  // by solves, by products, and by products kept
      rows.combine({}, in_all);
      CHECK((Eigen::Map<const Matrix>(point.coefficients, 8, point.size) - expected).norm() <= 1e-9);
    }
  }
}
