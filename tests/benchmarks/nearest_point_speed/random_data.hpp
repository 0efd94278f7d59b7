#pragma once

#include <random>

#include "families.hpp"

namespace speed {

/// Random data of the families: the same for the same seed.
class RandomData {
 public:
  explicit RandomData(unsigned seed) : generator_(seed) {}

  double normal() { return normal_(generator_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }

  Vector normals(Index n);
  /// Multiples of 2^-4, below 1/2: sums and products of a few are exact.
  Vector dyadic_row(Index n);
  /// Multiples of 2^-4 up to 2.
  Vector dyadic_point(Index n);
  RowMatrix unit_rows(Index m, Index n);
  /// Of condition 100, eigenvectors at random.
  Matrix positive_definite(Index n);
  /// 0 … count - 1, shuffled.
  std::vector<Index> shuffled(Index count);

 private:
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

}  // namespace speed
