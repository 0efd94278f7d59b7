#pragma once

#include <random>

#include "convex/cones/polyhedral_cone.hpp"

namespace tests {

/// Small integer rows of many kinds: with zeros, repeated, scaled and opposite rows, flat, with lines.
struct ConeData {
  convex::Matrix generators, lines;
};

inline ConeData random_cone_data(unsigned seed, convex::Index n) {
  using convex::Index;
  std::mt19937 random(seed);
  const auto integer = [&](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(random);
  };
  const Index m = integer(0, static_cast<int>(n) + 3), l = integer(0, 3) == 0 ? integer(1, 2) : 0;
  ConeData data{convex::Matrix(m, n), convex::Matrix(l, n)};
  const int largest = integer(1, 4), kind = integer(0, 4);
  for (Index i = 0; i < data.lines.size(); ++i) data.lines.data()[i] = integer(-1, 1);
  for (Index i = 0; i < m; ++i) {
    for (Index j = 0; j < n; ++j) data.generators(i, j) = integer(-largest, largest);
    if (kind == 1 && i > 0) data.generators.row(i) *= integer(0, 2);
    if (kind == 2 && i > 1 && integer(0, 2) == 0)
      data.generators.row(i) = data.generators.row(0) + integer(-1, 2) * data.generators.row(1);
    if (kind == 3) data.generators(i, n - 1) = integer(0, largest);
    if (kind == 4 && n > 1) data.generators(i, 0) = data.generators(i, n - 1);
  }
  return data;
}

inline convex::PolyhedralCone random_cone(unsigned seed, convex::Index n) {
  const ConeData data = random_cone_data(seed, n);
  return convex::generated_cone(data.generators, data.lines);
}

inline convex::Matrix random_matrix(unsigned seed, convex::Index rows, convex::Index columns) {
  std::mt19937 random(seed);
  convex::Matrix M(rows, columns);
  for (convex::Index i = 0; i < M.size(); ++i)
    M.data()[i] = std::uniform_int_distribution<int>(-2, 2)(random);
  return M;
}

/// Integers, or thirds rounded to doubles; positive definite.
inline convex::Matrix random_metric(unsigned seed, convex::Index n) {
  const convex::Matrix B = random_matrix(seed, n, n);
  return (B * B.transpose() + convex::Matrix::Identity(n, n)) / (seed % 2 == 0 ? 1.0 : 3.0);
}

inline convex::ExactRows exact(const convex::IntegerRows& rows) {
  convex::ExactRows made;
  for (const convex::IntegerVector& row : rows) made.push_back({row, 1});
  return made;
}

}  // namespace tests
