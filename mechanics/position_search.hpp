#pragma once

#include <optional>
#include <vector>

#include "convex/metric.hpp"
#include "mechanics/assembly.hpp"

namespace mechanics {

using convex::Matrix;

/// A position that is further from holding, relative to its scale, has not been found.
inline constexpr double not_found = 1e-9;
/// Less than this is rounding.
inline constexpr double rounding_part = 1e-12;
inline constexpr int most_restorations = 100;

/// The constraints at a position, for the free coordinates.
struct TriedPosition {
  Vector q;  ///< n
  Vector f, scale;
  Matrix U;            ///< every constraint by free coordinate
  double step = 1;     ///< the relative length of the last step that led here
  double missing = 0;  ///< the root of the sum of squares of what is violated, by scale
};

/// Looks for the nearest position of a mechanism at which its constraints hold.
class PositionSearch {
 public:
  PositionSearch(const LagrangianSystem& system, const State& guess, const AssemblyQuestion& question);

  const std::vector<Index>& free() const { return free_; }
  const Matrix& A() const { return A_; }
  bool is_equal(Index a) const { return is_equal_[static_cast<std::size_t>(a)]; }

  /// What is violated of constraint a.
  double violation(const TriedPosition& x, Index a) const;

  TriedPosition at(const Vector& q) const;

  double moved(const TriedPosition& x) const;

  /// Ends where nothing improves; `multipliers` of the last quadratic program.
  TriedPosition nearest(TriedPosition x) const;

  /// Levenberg's steps on the sum of squares of what is violated.
  TriedPosition restored(TriedPosition x, int steps) const;

  void leave_out(Index a, bool out) { is_left_out_[static_cast<std::size_t>(a)] = out; }

 private:
  static constexpr double unlimited = std::numeric_limits<double>::infinity();
  static double square(double x) { return x * x; }

  void take_rounding_for_zero(TriedPosition&) const;
  Vector within_reach(const TriedPosition&, Vector d) const;
  std::optional<TriedPosition> tried(const TriedPosition& x, const Vector& d, double part) const;

  /// Σ lambda_a ∂²f_a/∂q∂q by the second rates along directions.
  Matrix curvature(const TriedPosition& x, const Vector& lambda) const;

  /// A - Σ lambda_a ∂²f_a/∂q∂q where the rows that press hold it positive definite, made so by ½ρ(u_a·d +
  /// f_a)² of these rows, which is 0 at every step that they allow (Nocedal and Wright 2006, 17.3); z is that
  /// of the quadratic program. Else A.
  convex::Metric hessian(const TriedPosition& x, const Vector& lambda, Vector& z) const;

  struct Direction {
    Vector d;  ///< empty when the linearised constraints exclude each other
    Vector lambda;
  };

  Direction direction(const TriedPosition& x, const Vector& lambda) const;

  /// The step, or a part of it that brings the constraints or the distance down.
  TriedPosition moved_along(const TriedPosition& x, const Vector& d, const Vector& lambda) const;

  const LagrangianSystem& system_;
  const State& guess_;
  std::vector<Index> free_, all_;
  std::vector<bool> is_equal_, is_left_out_;
  Matrix A_;
  convex::Metric A_metric_ = convex::Metric::identity(0);
};

}  // namespace mechanics
