#pragma once

#include "convex/nearest_point/pivoting/gram_rows.hpp"

namespace convex::inline pivoting {

/// The Cholesky factor L Lᵀ of the Gram matrix of some of the rows looked at, the working set, kept up to
/// date as rows come and go: a row that comes is one more row of L; when one goes, what stands behind it
/// takes up its column, which is a change of rank one (Gill, Golub, Murray and Saunders 1974).
class GramFactor {
 public:
  GramFactor(const GramRows& rows, Arena& arena, Index capacity);
  /// Cache lines that it takes from the arena.
  static Index lines(Index capacity);

  Index size() const { return size_; }
  Index capacity() const { return capacity_; }
  Index place(Index j) const { return at_[j]; }
  Index row(Index j) const { return rows_.row(at_[j]); }
  const Index* places() const { return at_; }
  bool is_factored() const { return factored_; }

  /// Forgets all rows.
  void clear() { size_ = 0, factored_ = true; }
  /// Adds a row to be factored with the others by `factor`.
  void list(Index place) { at_[size_++] = place, factored_ = false; }
  /// Factors anew. False when a row has less than this part, squared, outside the span of those before it.
  bool factor(double part);
  /// Leaves out the rows that have less than that part outside the span of those kept before, in one pass
  /// without pivoting; left(j) tells of each, and is false to forbid it. False when that is so, or when
  /// nothing is left out.
  template <class Left>
  bool leave_dependent(double part, Left left) {
    gather();
    Index kept = 0;
    for (Index j = 0; j < size_; ++j) {
      if (!(pivot_of_plain_elimination(j) > part * rows_.square(at_[j]))) {
        if (!left(j)) return false;
        continue;
      }
      eliminate_plainly(j);
      at_[kept++] = at_[j];
    }
    if (kept == size_) return false;
    size_ = kept;
    factored_ = false;
    return true;
  }

  /// x: the products of a row with those held, padded; becomes its row of L. Its squared distance to their
  /// span.
  double distance(Index place, double* x) const;
  /// The same of up to eight rows, whose rows of L are not wanted.
  void distances(const Index* places, Index count, double* X, double* squared) const;
  /// Takes in a row with its row of L and squared distance.
  void append(Index place, const double* x, double distance);
  void remove(Index j);
  /// Lets go of all but the first `count`.
  void keep_first(Index count);

  /// x := (VᵀV)⁻¹x; padded.
  void solve(double* x) const;
  /// The same for eight vectors side by side.
  void solve_pack(double* X) const;
  /// x := L⁻ᵀx.
  void solve_upper(double* x) const;
  double pivot(Index j) const { return L_[j * (ld_ + 1)]; }

 private:
  void gather();
  double pivot_of_plain_elimination(Index j) const { return L_[j * (ld_ + 1)]; }
  void eliminate_plainly(Index j);
  void pad(Index from);
  void mirror(Index from);

  const GramRows& rows_;
  const DenseKernels& kernels_;
  const Index capacity_, ld_;
  double *L_, *inverse_, *column_;
  Index* at_;
  Index size_ = 0;
  bool factored_ = true;
};

}  // namespace convex::inline pivoting
