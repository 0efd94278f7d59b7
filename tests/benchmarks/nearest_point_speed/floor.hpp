#pragma once

#include "families.hpp"
#include "truth.hpp"

namespace speed {

/// The least that a solver from bare arrays must do, the rows of the answer known.
/// Feasible: A = LLᵀ, the rows whitened, a factor of their Gram matrix, q, one look at all rows.
/// Infeasible: A = LLᵀ, the rows of the contradiction whitened, a factor of the Gram matrix of all but one,
/// weights.
class Floor {
 public:
  Floor(const DenseProblem&, const Truth&);
  /// A number that depends on all of it.
  double run() const;

 private:
  double point() const;
  double contradiction() const;

  const DenseProblem& problem_;
  std::vector<Index> rows_;
  bool feasible_;
  bool orthogonal_ = false;  // rows so close that only an orthogonal factor exists in doubles
};

}  // namespace speed
