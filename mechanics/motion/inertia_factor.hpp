#pragma once

#include <span>
#include <vector>

#include "mechanics/state.hpp"

namespace mechanics::inline motions {

/// A = M D Mᵀ for few coordinates, M with a diagonal of 1, made anew at each step in the same memory.
class InertiaFactor {
 public:
  /// False, and nothing is known, where a pivot is lost in the rounding of its diagonal entry.
  bool make(const convex::Matrix& A);
  bool is_made() const { return is_made_; }

  /// x becomes A⁻¹x.
  void solve(Vector& x) const { solve(x.data()); }
  void solve(double* x) const;
  /// ||x||_A = |sqrt(D) Mᵀx|.
  double norm(std::span<const double> x) const;
  /// A = L D Lᵀ: rows of L below the diagonal, and 1 / D.
  const double* lower() const { return M_.data(); }
  const double* inverse_of_diagonal() const { return inverse_.data(); }
  /// ||x_k||_A for vectors x_k, k < count, with zeros up to a multiple of eight. x: n rows of so many
  /// numbers.
  void norms(const double* const* x, double* of, std::size_t count) const;

 private:
  Index n_ = 0;
  bool is_made_ = false;
  std::vector<double> M_;               // rows, below the diagonal
  std::vector<double> root_, inverse_;  // sqrt(D_ii), 1 / D_ii
};

}  // namespace mechanics::inline motions
