#pragma once

#include <utility>
#include <vector>

#include "convex/vector.hpp"

namespace mechanics {

using convex::Index;
using convex::Vector;

/// An equation row·q'' = rhs that third derivatives give where gradients depend on each other: Σ w_a
/// d³f_a/dt³ = 0 with Σ w_a u_a = 0, so that q''' drops out and row = 3 Σ w_a (H_a q' + ∂u_a/∂t).
/// Or, where f_a vanishes just where some linear forms do, one of these, row·(q - q_0), with rhs 0.
struct AddedRow {
  std::vector<std::pair<Index, double>> weights;  ///< by constraint
  Vector row;                                     ///< n
  double rhs = 0;
  double row_radius = 0, rhs_radius = 0;  ///< as convex::DataRadii has them
  Index main = 0;                         ///< the constraint whose gradient the others of `weights` make up
  bool is_linear_form = false;            ///< a row of the Hessian of `main`, not of third derivatives
};

}  // namespace mechanics
