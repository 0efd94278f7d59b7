#pragma once

#include <vector>

#include "convex/double_double.hpp"
#include "convex/linear_algebra/orthogonal_factor.hpp"
#include "convex/nearest_point/problem.hpp"
#include "convex/zero_tolerances.hpp"

namespace convex::inline working_set {

/// Whether factors of n·min(n, m) numbers are affordable. Beyond, methods and crossover go by sparse ones.
bool is_dense_size(const NearestPointProblem&);

/// What twice the working precision leaves of a row that depends on the others exactly, of its magnitude.
inline constexpr double exact_dependence = zero_of_long_sums;

/// In a block (`append_block`) a row this close to the span of the others is looked at alone.
inline constexpr double block_dependence = 1e-7;

/// F⁻¹u_a of the rows given, as columns.
Matrix whitened_rows(const NearestPointProblem&, const std::vector<Index>& rows);

/// The working set S, rows held with equality, and the point that they define, in whitened terms: v_a =
/// F⁻¹u_a, w = Fᵀq, w_free = F⁻¹z; w = w_free + Σ_S lambda_a v_a with v_a·w = s_a on S.
class WorkingSet {
 public:
  explicit WorkingSet(const NearestPointProblem&);

  const NearestPointProblem& problem() const { return problem_; }
  Index size() const { return factor_.size(); }
  const std::vector<Index>& rows() const { return rows_; }
  bool holds(Index a) const { return position_[at(a)] >= 0; }
  /// Whether row k of S is one-sided; two-sided ones are never dropped.
  bool one_sided(Index k) const { return !two_sided_[at(rows_[at(k)])]; }

  const linear_algebra::OrthogonalFactor& factor() const { return factor_; }
  const Vector& w_free() const { return w_free_; }
  Vector& w() { return w_; }
  const Vector& w() const { return w_; }
  Vector& lambda() { return lambda_; }
  const Vector& lambda() const { return lambda_; }
  /// q = F⁻ᵀw.
  Vector point() const;
  /// max(||q||_A, ||z||_(A⁻¹)): what errors are relative to; q also that of the shortest motion that holds S,
  /// which may have rows that the point has not been solved for.
  double scale() const;

  /// u_p = Σ_S r_k u_k + (what S does not span): `direction` is the whitened rest d, `coefficients` is r (k
  /// entries), `c` = Qᵀv. When the row is nearly dependent, found with residuals of the *original* rows in
  /// twice the working precision, so that d keeps its digits whatever the angle.
  struct Split {
    Vector c, coefficients, direction;
    double length = 0;          ///< |v_p|
    double rho = 0;             ///< |d|; 0 when the row is dependent within the rounding of the data
    double rest = 0;            ///< |d| as twice the working precision has it
    double magnitude = 0;       ///< |v_p| + Σ |r_k| |v_k|: what rounding of the rows is relative to
    bool within_radii = false;  ///< rho is 0 because of the radii that the rows came with
  };
  void split(Index p, Split& into);

  void append(Index p, const Split&, double multiplier);
  void remove(Index k);
  /// Takes in those of the rows that are independent of the others to the relative threshold; w and the
  /// multipliers are not touched.
  void append_block(const std::vector<Index>& rows, double threshold);
  /// Sets w and lambda to the point where every row of S holds with equality.
  void solve();
  /// Solves A dq - U_Sᵀ dlambda = r1, U_S dq = r2, given g = F⁻¹r1; returns dw = Fᵀdq.
  void correct(const Vector& g, Vector r2, Vector& dw, Vector& dlambda) const;

 private:
  /// R⁻ᵀs of S: in the span of its rows, the nearest motion to 0 that holds them.
  Vector shortest_motion() const;
  void sharpen(Index p, Split& split);
  void take(Index p);

  const NearestPointProblem& problem_;
  linear_algebra::OrthogonalFactor factor_;
  std::vector<Index> rows_;
  std::vector<Index> position_;  // of row a in rows_, or -1
  std::vector<bool> two_sided_;
  Vector w_free_, w_, lambda_;
};

}  // namespace convex::inline working_set
