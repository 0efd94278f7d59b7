#pragma once

#include <optional>

#include "convex/exact/rounding_bounds.hpp"
#include "convex/nearest_point/entry_radii.hpp"
#include "convex/nearest_point/problem.hpp"

/// The point that some rows define, with proved bounds for every problem within radii of the one given
/// (docs/proof.md, section 3).
namespace convex::inline proof {

/// Radii of a problem as sums over them need it; all 0 where none are given.
class RadiiOf {
 public:
  explicit RadiiOf(const EntryRadii* radii) : radii_(radii) {}
  bool any() const { return radii_ != nullptr; }
  /// Â x and Û_S x, Û_Sᵀ y and ŝ_S for x, y >= 0.
  Vector A_times(const Vector& x) const {
    return any() ? Vector(radii_->A * x) : Vector(Vector::Zero(x.size()));
  }
  Vector z(Index n) const { return any() ? radii_->z : Vector(Vector::Zero(n)); }
  double row_times(Index a, const Vector& x) const { return any() ? radii_->U.row(a).dot(x) : 0; }
  double s(Index a) const { return any() ? radii_->s[a] : 0; }
  Vector rows_times(const std::vector<Index>& rows, const Vector& x) const;
  Vector rows_transposed_times(const std::vector<Index>& rows, const Vector& y, Index n) const;

 private:
  const EntryRadii* radii_;
};

/// A metric seen through X ≈ F⁻¹: A' = X A Xᵀ = I + Δ with |Δ|₂ <= delta < 1.
struct Preconditioned {
  bool is_diagonal = false;
  Matrix A, X;  // dense
  Vector a, x;  // the diagonals, when A is diagonal
  double delta = 1;

  Vector times_X(const Vector& c) const { return is_diagonal ? Vector(x.cwiseProduct(c)) : Vector(X * c); }
  Vector times_X_transposed(const Vector& p) const {
    return is_diagonal ? Vector(x.cwiseProduct(p)) : Vector(X.transpose() * p);
  }
  /// |X| c for c >= 0.
  Vector spread(const Vector& c) const {
    return is_diagonal ? Vector(x.cwiseAbs().cwiseProduct(c)) : Vector(X.cwiseAbs() * c);
  }
  Vector times_A(const Vector& q) const { return is_diagonal ? Vector(a.cwiseProduct(q)) : Vector(A * q); }
  Vector magnitude_times_A(const Vector& q) const {
    return is_diagonal ? Vector(a.cwiseProduct(q)) : Vector(A.cwiseAbs() * q);
  }
  Index dimension() const { return is_diagonal ? a.size() : A.rows(); }
};

/// None when a number is out of the range that bounds are made for.
std::optional<Preconditioned> preconditioned(const Metric&, const RadiiOf&);

/// What is known of the point that some rows define: q + dq within `radius` in the metric, its multipliers
/// lambda + dlambda within theirs.
struct HeldPoint {
  Vector q, dq, lambda, dlambda, multiplier_radius;
  double radius = 0;
};

/// r1 = z + U_Sᵀlambda - A q and r2 = s_S - U_S q at q + dq and lambda + dlambda, each known to its radius
/// for every problem within the radii.
struct KktResidual {
  Vector r1, r1_radius, r2, r2_radius;
};
KktResidual kkt_residual(const NearestPointProblem&, const RadiiOf&, const std::vector<Index>& rows,
                         const HeldPoint&);

/// Rows held with equality, and their point. Seen through X and T ≈ R⁻¹ they are independent: Z = X U_Sᵀ T,
/// ZᵀZ = I + Δ with |Δ|₂ <= delta < ½. The problem, its radii and its metric are referred to.
struct HeldRows {
  const NearestPointProblem& problem;
  const RadiiOf& radii;
  const Preconditioned& P;
  std::vector<Index> rows;
  Matrix U;  // of the rows, k×n
  Matrix T, Z;
  double delta = 0;
  HeldPoint point = {};

  /// lambda_k + dlambda_k at least.
  double least_multiplier(Index k) const {
    return below(point.lambda[k] + point.dlambda[k]) - above(point.multiplier_radius[k]);
  }
};

/// From a guess of their point, q (n) and lambda (m), refined as far as that helps. None when rows are
/// dependent, for all that doubles tell.
std::optional<HeldRows> hold(const NearestPointProblem&, const RadiiOf&, const Preconditioned&,
                             const std::vector<Index>& rows, const Vector& q, const Vector& lambda);

/// At least ||Aq - z - U_Sᵀ(lambda + dlambda)||_(A⁻¹), the dq of the point left out.
double unbalanced_above(const HeldRows&);

/// At least ||dq||_A, for every metric within the radii.
double length_above(const Preconditioned&, const RadiiOf&, const Vector& dq);

/// At least ||c||_(A⁻¹), |c_i| known to within `spread_i`, for every metric within the radii.
double dual_length_above(const Preconditioned&, const Vector& c, const Vector& spread);

}  // namespace convex::inline proof
