#pragma once

#include <random>
#include <string>

#include "convex/nearest_point/problem.hpp"

namespace oracles {

/// Ways in which a problem can be hard for a solver.
enum class Difficulty {
  none,
  repeated_rows,
  sums_of_rows,
  at_rest,
  two_sided_rows,
  opposite_rows,
  sparse_rows
};

/// A problem with small integer data whose solution is known by construction: x and lambda >= 0 are chosen
/// first, then s = Ux - slack and z = Ax - Uᵀlambda, all exact in doubles.
struct PlantedProblem {
  convex::NearestPointProblem problem;
  convex::Vector solution;
};

inline PlantedProblem planted_problem(unsigned seed, convex::Index n, convex::Index m,
                                      Difficulty difficulty) {
  using convex::Index;
  std::mt19937 generator(seed);
  const auto integer = [&](int low, int high) {
    return static_cast<double>(std::uniform_int_distribution<int>(low, high)(generator));
  };
  const auto index = [&](Index below) { return static_cast<Index>(integer(0, static_cast<int>(below) - 1)); };
  convex::Matrix B(n, n);
  for (Index i = 0; i < B.size(); ++i) B.data()[i] = integer(-2, 2);
  const convex::Matrix A = B * B.transpose() + static_cast<double>(n) * convex::Matrix::Identity(n, n);
  convex::RowMatrix U(m, n);
  const bool sparse = difficulty == Difficulty::sparse_rows;
  for (Index i = 0; i < U.size(); ++i) U.data()[i] = sparse && integer(0, 3) > 0 ? 0 : integer(-2, 2);
  for (Index a = m / 2; a < m && m >= 4; ++a) {
    if (difficulty == Difficulty::repeated_rows) U.row(a) = U.row(index(m / 2)).eval();
    if (difficulty == Difficulty::sums_of_rows) U.row(a) = (U.row(index(m / 2)) + U.row(index(m / 2))).eval();
    if (difficulty == Difficulty::opposite_rows) U.row(a) = -U.row(index(m / 2)).eval();
  }
  convex::Vector x(n), lambda = convex::Vector::Zero(m);
  for (Index i = 0; i < n; ++i) x[i] = difficulty == Difficulty::at_rest ? 0 : integer(-9, 9);
  convex::Vector s = U * x;
  std::vector<Index> two_sided;
  for (Index a = 0; a < m; ++a) {
    const int kind = static_cast<int>(integer(0, 2));  // loaded, apart, or weakly active
    if (difficulty == Difficulty::two_sided_rows && integer(0, 5) == 0) {
      two_sided.push_back(a);
      lambda[a] = integer(-9, 9);
    } else if (kind == 0) {
      lambda[a] = integer(1, 9);
    } else if (kind == 1) {
      s[a] -= integer(1, 9);
    }
  }
  const convex::Vector z = A * x - U.transpose() * lambda;
  return {{convex::Metric::dense(A), z, convex::ConstraintRows(U), s, two_sided}, x};
}

}  // namespace oracles
