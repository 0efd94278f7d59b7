#include <doctest/doctest.h>

#include <random>

#include "mechanics/row_space.hpp"

using namespace mechanics;

namespace {

RowMatrix random_rows(Index m, Index n, std::mt19937& random) {
  std::normal_distribution<double> normal;
  RowMatrix rows(m, n);
  for (Index a = 0; a < m; ++a)
    for (Index i = 0; i < n; ++i) rows(a, i) = normal(random);
  return rows;
}

}  // namespace

TEST_CASE("combinations of rows are found with their coefficients, whatever the order and the units") {
  std::mt19937 random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const Index n = 3 + trial % 6, independent = 1 + trial % 3;
    const RowMatrix basis = random_rows(independent, n, random);
    RowMatrix rows(independent + 2, n);
    rows.topRows(independent) = basis;
    rows.bottomRows(2) = random_rows(2, independent, random) * basis;
    for (Index a = 0; a < rows.rows(); ++a) rows.row(a) *= std::pow(10.0, (trial + 3 * a) % 9 - 4);
    const RowMatrix shuffled = rows.colwise().reverse();
    RowSpace space(n);
    const SplitRows split = split_rows(shuffled, Vector::Zero(rows.rows()), space);
    REQUIRE(static_cast<Index>(split.kept.size()) == independent);
    for (std::size_t d = 0; d < split.dependent.size(); ++d) {
      Vector combination = Vector::Zero(n);
      double most = 0;
      for (std::size_t k = 0; k < split.kept.size(); ++k) {
        const Vector part =
            split.expansions[d].coefficients[static_cast<Index>(k)] * shuffled.row(split.kept[k]).transpose();
        combination += part;
        most = std::max(most, part.norm());
      }
      const Vector row = shuffled.row(split.dependent[d]).transpose();
      CHECK((combination - row).norm() <= 1e-13 * std::max(most, row.norm()));
    }
  }
}

TEST_CASE("rows are independent beyond their radii and never within them") {
  RowMatrix rows(2, 2);
  for (const double angle : {1e-3, 1e-8, 1e-13}) {
    CAPTURE(angle);
    rows << 1, 0, 1, angle;
    for (const double part : {0.3, 3.0}) {
      RowSpace space(2);
      const SplitRows split = split_rows(rows, Vector::Constant(2, part * angle), space);
      // Two radii of 0.3 angle leave some of the angle, of 3 none.
      CHECK(split.kept.size() == (part < 1 ? 2 : 1));
    }
  }
}

TEST_CASE("a row within its radius of 0 is independent of nothing") {
  RowMatrix rows(2, 2);
  rows << 1e-17, -2e-17, 1, 1;
  RowSpace space(2);
  const SplitRows split = split_rows(rows, Vector::Constant(2, 3e-17), space);
  CHECK(split.kept == std::vector<Index>{1});
  CHECK(split.dependent == std::vector<Index>{0});
}
