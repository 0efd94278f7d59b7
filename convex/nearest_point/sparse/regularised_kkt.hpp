#pragma once

#include <memory>

#include "convex/nearest_point/problem.hpp"

namespace convex::inline sparse {

/// The equations A dq - U_Jᵀ dlambda = r1, U_J dq + Theta dlambda = r2 for some rows J and a diagonal Theta >
/// 0: what one step of an interior-point, augmented Lagrangian or splitting method comes to. Quasidefinite,
/// so that a factor exists for any J (Vanderbei 1995). Dense: on whitened rows, as V Theta⁻¹Vᵀ + I or VᵀV +
/// Theta, whichever is smaller. Sparse: L D Lᵀ of the whole with a fill-reducing order, used when the problem
/// is too large for dense factors.
class RegularisedKkt {
 public:
  explicit RegularisedKkt(const NearestPointProblem&);
  ~RegularisedKkt();

  /// Factors for the rows J with the entries theta of Theta: |J|. False when that fails.
  bool factor(const std::vector<Index>& rows, const Vector& theta);
  /// Solves with the last factor. r1: n, r2: |J|.
  void solve(const Vector& r1, const Vector& r2, Vector& dq, Vector& dlambda) const;

 private:
  struct Dense;
  struct Sparse;
  const NearestPointProblem& problem_;
  std::unique_ptr<Dense> dense_;
  std::unique_ptr<Sparse> sparse_;
};

}  // namespace convex::inline sparse
