#include "convex/linear_algebra/front_kernels.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using convex::Index;
using convex::Matrix;

namespace {

/// Of random numbers, with a diagonal that outweighs the rest of its row.
Matrix dominated(Index n, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> draw(-1, 1);
  Matrix M(n, n);
  for (Index j = 0; j < n; ++j)
    for (Index i = j; i < n; ++i) M(i, j) = M(j, i) = draw(generator);
  M.diagonal().array() += 2.0 * static_cast<double>(n);
  return M;
}

}  // namespace

TEST_CASE("columns eliminated leave the Schur complement of the others, however many they are") {
  for (const Index rows : {1, 2, 3, 5, 8, 9, 15, 16, 17, 31, 33, 64, 300})
    for (const Index columns : {1, 2, 3, 4, 5, 7, 8, 9, 13, 24, 130, 300}) {
      if (columns > rows) continue;
      CAPTURE(rows);
      CAPTURE(columns);
      const Matrix M = dominated(rows, static_cast<unsigned>(rows + 1000 * columns));
      std::vector<double> panel(
          static_cast<std::size_t>(rows * columns + convex::linear_algebra::read_beyond), 7.0);
      for (Index j = 0; j < columns; ++j)
        for (Index i = j; i < rows; ++i) panel[static_cast<std::size_t>(j * rows + i)] = M(i, j);
      REQUIRE(convex::linear_algebra::factor_panel(panel.data(), rows, columns));
      const Index below = rows - columns;
      const Matrix first = M.topLeftCorner(columns, columns), beside = M.bottomLeftCorner(below, columns);
      const Matrix inverse = first.inverse();
      const double bound = 1e-15 * static_cast<double>(rows) * M.norm();

      Matrix L = Matrix::Identity(columns, columns), D = Matrix::Zero(columns, columns);
      Matrix under(below, columns);
      for (Index j = 0; j < columns; ++j) {
        const double* column = panel.data() + j * rows;
        D(j, j) = column[j];
        for (Index i = j + 1; i < columns; ++i) L(i, j) = column[i];
        for (Index i = 0; i < below; ++i) under(i, j) = column[columns + i];
      }
      CHECK((L * D * L.transpose() - first).norm() <= bound);
      CHECK((under * D * L.transpose() - beside).norm() <= bound);

      Matrix update = Matrix::Constant(below, below, 7.0);
      convex::linear_algebra::outer_product(update.data(), below, panel.data(), rows, columns);
      const Matrix taken = beside * inverse * beside.transpose();
      double error = 0;
      for (Index j = 0; j < below; ++j)
        for (Index i = j; i < below; ++i) error = std::max(error, std::abs(update(i, j) + taken(i, j)));
      CHECK(error <= bound);
    }
}

TEST_CASE("an update is added where its rows stand, each number of its lower triangle once") {
  const std::vector<int> place{0, 1, 2, 5, 6, 9, 11, 12, 13, 14};
  const auto size = static_cast<Index>(place.size());
  const Index stride = 16, from = 2, to = 7;
  Matrix update(size, size), target = Matrix::Zero(stride, stride);
  for (Index j = 0; j < size; ++j)
    for (Index i = 0; i < size; ++i) update(i, j) = static_cast<double>(1 + i + 100 * j);
  convex::linear_algebra::add_columns(update.data(), size, from, to, place.data(), target.data(), stride);
  Matrix expected = Matrix::Zero(stride, stride);
  for (Index j = from; j < to; ++j)
    for (Index i = j; i < size; ++i)
      expected(place[static_cast<std::size_t>(i)], place[static_cast<std::size_t>(j)]) = update(i, j);
  CHECK(target == expected);
}
