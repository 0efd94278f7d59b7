#pragma once

#include <memory>
#include <vector>

#include "convex/composite/atom.hpp"

namespace convex::inline composite {

/// One term scale · f(M ξ + b) of a graph form. M: dim × (n + k), b: dim, scale > 0.
struct GraphTerm {
  std::shared_ptr<const Atom> f;
  double scale = 1;
  SparseMatrix M;
  Vector b;
};

/// f(x) = constant + min over w of sum_j scale_j f_j(M_j ξ + b_j), ξ = (x, w), x: n, w: k auxiliary
/// variables. Sums, inf-convolutions, maxima, compositions with affine maps and conjugates of graph forms are
/// graph forms.
struct GraphForm {
  Index n = 0;
  Index k = 0;
  std::vector<GraphTerm> terms;
  double constant = 0;
  bool by_slope = false;  ///< heights in it are measured in units of a slope
  bool by_point = false;  ///< and those of functions of a subgradient in units of a point
};

}  // namespace convex::inline composite
