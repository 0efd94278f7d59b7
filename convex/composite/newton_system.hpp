#pragma once

#include <optional>
#include <vector>

#include "convex/composite/saddle_problem.hpp"
#include "convex/linear_algebra/cholesky.hpp"
#include "convex/linear_algebra/pivoted_lu.hpp"
#include "convex/linear_algebra/sparse_factor.hpp"

namespace convex::inline composite {

/// The second order of a term at t: with J the Jacobian of its prox in D and theta in (0, 1],
///   B = J + theta (I - J),  H = D (I - J) B⁻¹,
/// the Hessian of the term after an envelope of size D/theta. Of a thin J
///   B⁻¹ = diag(b_inverse) - (1 - theta) P S Pᵀ,  H = diag(h) - D P S Pᵀ,
/// P having no columns for separable terms; else both are full.
struct TermCurvature {
  bool is_thin = false;
  Vector h, b_inverse;
  Matrix P, S;
  Matrix H, B_inverse;
};

/// A step: M(ξ + dxi) + b - (u + J dt) = theta (I - J) dt, dy = D(I - J) dt = H(M dxi + r), and the gradient
/// of the Lagrangian after it is -ridge·dw.
struct NewtonStep {
  Vector dxi, dt, dy;
};

/// What a dense factor of so many unknowns counts as, in evaluations.
long work_of_a_factor(Index unknowns);

/// The optimality conditions linearised at a t. theta = 1 gives the Hessian of the method of multipliers'
/// inner problem; theta -> 0 Newton's method on the conditions themselves.
class NewtonSystem {
 public:
  /// ridge: k, the proximal term on w.
  NewtonSystem(const SaddleProblem&, const Vector& t, const Vector& D, double theta, const Vector& ridge);
  /// Solves (G + ridge + MᵀHM) dxi = -rho - MᵀHr.
  NewtonStep step(const Vector& rho, const Vector& r) const;
  /// False when the matrix was not positive definite in working precision.
  bool usable() const { return usable_; }

 private:
  /// The matrix as that of many sparse coordinates and a few columns besides, by the formula of Woodbury;
  /// false where it is none.
  bool factor_sparse(const Vector& ridge);
  void factor_dense(const Vector& ridge);
  Vector solve(const Vector& right) const;

  const SaddleProblem* problem_;
  double theta_;
  Vector scale_;  ///< D: m
  std::vector<TermCurvature> curvature_;
  linear_algebra::Cholesky factor_;
  std::optional<linear_algebra::SparseFactor> sparse_;
  Matrix columns_, spread_;  ///< Y, and K⁻¹Y with the sparse part K
  linear_algebra::PivotedLu small_;
  Matrix weight_;  ///< E of K + Y E Yᵀ
  bool usable_ = true;
};

}  // namespace convex::inline composite
