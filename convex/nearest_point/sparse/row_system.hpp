#pragma once

#include <variant>

#include "convex/linear_algebra/band_factor.hpp"
#include "convex/linear_algebra/sparse_factor.hpp"
#include "convex/nearest_point/reductions/balanced_problem.hpp"

namespace convex::inline sparse {

/// A + Uᵀ D U for weights D >= 0 that change, with one order for all: the given one where that makes a narrow
/// band, else a fill-reducing one. Rows with many entries would fill it:
/// they stand beside it, as -1/D on the diagonal and u_a at the border, which keeps it quasi-definite.
class RowSystem {
 public:
  explicit RowSystem(const BalancedProblem&);

  /// False when the factorisation breaks down.
  bool factor(const Vector& weight);
  /// (A + Uᵀ D U)⁻¹ r.
  Vector solve(const Vector& r) const;
  /// Multiplications of a factorisation; numbers in a factor.
  double flops() const;
  double nonzeros() const;
  Index factorisations() const { return factorisations_; }

 private:
  struct Pattern {
    std::vector<linear_algebra::SparseFactor::Place> places;
    std::vector<double> of_A, of_rows, of_border;
    std::vector<Index> first;  ///< of the products of each short row
    std::vector<Index> long_rows, border_entries;
  };
  static Pattern pattern(const BalancedProblem&);
  static std::variant<linear_algebra::SparseFactor, linear_algebra::BandFactor> analysed(
      Index n, const std::vector<linear_algebra::SparseFactor::Place>&);
  RowSystem(const BalancedProblem&, Pattern);

  Index n_;
  Pattern pattern_;
  std::variant<linear_algebra::SparseFactor, linear_algebra::BandFactor> factor_;
  std::vector<Index> slots_;
  Index factorisations_ = 0;
};

}  // namespace convex::inline sparse
