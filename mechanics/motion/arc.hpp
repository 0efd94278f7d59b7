#pragma once

#include <span>
#include <vector>

#include "mechanics/state.hpp"

namespace mechanics::inline motions {

/// A piece of the motion without events inside, by its Taylor polynomials: q(t + τ), the multipliers of the
/// contacts that persist, and the constraints, for 0 <= τ <= length.
struct Arc {
  double t = 0;
  double length = 0;
  convex::RowMatrix q;         ///< n rows of coefficients 0 to N
  convex::RowMatrix lambda;    ///< m rows of coefficients 0 to N - 2
  convex::RowMatrix f;         ///< m rows of coefficients 0 to N
  std::vector<Index> persist;  ///< the contacts held on the arc

  Vector position(double tau) const;
  Vector velocity(double tau) const;
  Vector acceleration(double tau) const;
  Vector multipliers(double tau) const;
  State state(double tau) const;
  /// The same in memory that is there.
  void state(double tau, State& at) const;
  /// With the acceleration.
  void state(double tau, State& at, Vector& q2) const;
};

/// Row a of coefficients.
inline std::span<const double> coefficients(const convex::RowMatrix& of, Index a) {
  return {of.data() + a * of.cols(), static_cast<std::size_t>(of.cols())};
}

}  // namespace mechanics::inline motions
