#pragma once

#include <array>
#include <vector>

#include "convex/linear_algebra/elimination_order.hpp"
#include "convex/linear_algebra/front_kernels.hpp"

namespace convex::linear_algebra {

/// L D Lᵀ of a symmetric matrix of fixed pattern whose values change: positive definite, or quasi-definite
/// (Vanderbei 1995: blocks E and -F, both positive definite), which has such a factor in every order.
/// Multifrontal (Duff and Reid 1983), in an `elimination_order`, columns of like structure gathered in dense
/// panels (Ashcraft and Grimes 1989).
class SparseFactor {
 public:
  /// One place (i, j) of the matrix or of its mirror image.
  struct Place {
    int i, j;
  };

  /// places: the pattern, each place once or several times, in either triangle; the diagonal is always there.
  /// n: order.
  SparseFactor(Index n, const std::vector<Place>& places);

  /// Where the value of each of these places belongs in `values`.
  std::vector<Index> slots(const std::vector<Place>& places) const;
  /// The values, to be filled in before `factor`, which overwrites them.
  std::vector<double>& values() { return values_; }
  void clear_values() { std::fill(values_.begin(), values_.end(), 0.0); }

  /// False when a pivot is 0 or not finite.
  bool factor();
  /// x := K⁻¹x.
  void solve(Vector& x) const;

  Index dimension() const { return static_cast<Index>(new_place_.size()); }
  /// Numbers in L, zeros taken in by gathering columns included; multiplications of a factorisation.
  double nonzeros() const { return static_cast<double>(values_.size()) - read_beyond; }
  double flops() const { return flops_; }
  /// Pivots of `factor`, in the order of the coordinates.
  Vector pivots() const;

 private:
  /// Columns first … first + columns - 1 of L, dense on their common rows.
  struct Panel {
    Index first = 0, columns = 0, rows = 0;  ///< rows: columns, then those below
    Index values = 0, row_list = 0, parent = -1, below_in_parent = 0;
    std::size_t children = 0;
    std::size_t stack = 0;  ///< of its update: not the one that has those of its children
    Index below() const { return rows - columns; }
  };

  void find_panels(const std::vector<Index>& parent, const std::vector<Index>& count);
  void find_rows(const Neighbours&, const std::vector<int>& old_place);

  std::vector<int> new_place_;  // of a coordinate
  std::vector<Panel> panels_;
  std::vector<int> panel_of_;         // of a column
  std::vector<int> rows_;             // row lists of the panels
  std::vector<int> below_in_parent_;  // where the rows below a panel are among those of its parent
  std::vector<double> values_;
  std::array<std::vector<double>, 2> updates_;  // stacks of update matrices
  double flops_ = 0;
  Index longest_ = 0;  // rows of a panel
};

}  // namespace convex::linear_algebra
