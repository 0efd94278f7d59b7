#pragma once

#include "convex/dense/arena.hpp"
#include "convex/nearest_point/problem.hpp"

namespace convex::inline pivoting {

/// Rows of a dense problem that have been looked at, by eights side by side (`DenseKernels`), as they are and
/// whitened, v_a = L⁻¹u_a, with the Gram matrix of the latter. Each has a place; places without a row hold
/// zeros.
class GramRows {
 public:
  /// Room for so many places; w_free = L⁻¹z, padded.
  GramRows(const NearestPointProblem& problem, Arena& arena, Index most, const double* w_free);
  /// Cache lines that it takes from the arena.
  static Index lines(Index n, Index m, Index most) {
    return (padded(most) * (2 * n + padded(most) + 3) + padded(m)) / 8;
  }

  /// Takes rows in that are not there yet. False when there is no room for them.
  bool add(const Index* rows, Index count);

  /// After z and s of the problem have changed, and w_free with them.
  void reload();

  Index count() const { return count_; }                ///< places, a multiple of 8
  Index row(Index place) const { return row_[place]; }  ///< -1 for none
  Index place(Index row) const { return place_[row]; }  ///< -1 for none
  const double* raw() const { return raw_; }            ///< count/8 blocks of n packs
  const double* whitened() const { return whitened_; }  ///< the same
  const double* gram(Index place) const { return gram_ + place * most_; }
  Index stride() const { return most_; }                                   ///< of the Gram matrix
  double square(Index place) const { return gram_[place * (most_ + 1)]; }  ///< |v_a|²
  const double* s() const { return s_; }
  const double* load() const { return load_; }  ///< s_a - v_a·w_free

 private:
  void load(Index first);

  const NearestPointProblem& problem_;
  Index n_, most_, count_ = 0;
  const double* w_free_;
  double *raw_, *whitened_, *gram_, *s_, *load_;
  Index *row_, *place_;
};

}  // namespace convex::inline pivoting
