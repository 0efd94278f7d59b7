#pragma once

#include <span>
#include <vector>

#include "mechanics/state.hpp"

namespace mechanics {

/// A = L Lᵀ for few coordinates, made anew at each step in the same memory.
class InertiaFactor {
 public:
  /// False, and nothing is known, where a pivot is lost in the rounding of its diagonal entry.
  bool make(const convex::Matrix& A);
  bool is_made() const { return is_made_; }
  void forget() { is_made_ = false; }

  /// x becomes A⁻¹x.
  void solve(Vector& x) const;
  /// ||x||_A = |Lᵀx|.
  double norm(std::span<const double> x) const;
  /// L_ij, i >= j.
  double operator()(Index i, Index j) const { return L_[static_cast<std::size_t>(i * n_ + j)]; }

 private:
  Index n_ = 0;
  bool is_made_ = false;
  std::vector<double> L_;        // rows, lower part
  std::vector<double> inverse_;  // 1 / L_ii
};

}  // namespace mechanics
