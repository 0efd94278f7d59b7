#pragma once

#include "convex/metric.hpp"
#include "mechanics/lagrangian_system.hpp"

namespace mechanics::inline motions {

/// Coordinates y of the states near one that satisfies the two-sided constraints in f and df/dt: 2 d numbers,
/// d = n minus the number of independent rows. With U N = 0, Nᵀ A N = 1, a state belongs to
///   y = (Nᵀ A (q - q0), Nᵀ A (v - v0)),
/// and y is brought back to q0 + N y_1, v0 + N y_2 and from there to the constraints by Newton's method along
/// A⁻¹Uᵀ, which y does not see. Without such constraints y is q - q0 and v - v0 themselves.
class TangentChart {
 public:
  /// The state is brought to the constraints first. Throws InvalidInput when that does not succeed, as where
  /// rows become dependent.
  TangentChart(const LagrangianSystem& system, const State& near);

  const State& origin() const { return origin_; }
  Index dimension() const { return 2 * N_.cols(); }
  /// q and v of the state that y belongs to, one after the other: 2n.
  Vector state_of(const Vector& y) const;
  /// y of a difference of states: 2n to 2d.
  Vector along(const Vector& difference) const;
  /// The direction in q and v of one of the coordinates, to first order in f alone.
  Vector direction(Index k) const;

 private:
  State projected(State at) const;

  const LagrangianSystem& system_;
  std::vector<Index> two_sided_;
  State origin_;
  convex::Matrix N_, dual_;  // dual_ = Nᵀ A
};

}  // namespace mechanics::inline motions
