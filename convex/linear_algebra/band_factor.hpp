#pragma once

#include <vector>

#include "convex/linear_algebra/sparse_factor.hpp"

namespace convex::linear_algebra {

/// L D Lᵀ of a symmetric matrix whose entries are all close to the diagonal, in the order as it stands: the
/// matrix of a string, a beam, or a chain with its springs. Used as `SparseFactor` is.
class BandFactor {
 public:
  using Place = SparseFactor::Place;

  /// The largest distance of a place from the diagonal.
  static Index width(const std::vector<Place>&);
  /// width: no place is further from the diagonal.
  BandFactor(Index n, Index width);

  std::vector<Index> slots(const std::vector<Place>&) const;
  std::vector<double>& values() { return values_; }
  void clear_values() { std::fill(values_.begin(), values_.end(), 0.0); }
  /// False when a pivot is 0 or not finite.
  bool factor();
  /// x := K⁻¹x.
  void solve(Vector& x) const;

  Index dimension() const { return n_; }
  double nonzeros() const { return static_cast<double>(values_.size()); }
  double flops() const;

 private:
  Index n_, width_;
  std::vector<double> values_;  // of column j, from the diagonal down: width + 1 numbers, past the end 0
};

}  // namespace convex::linear_algebra
