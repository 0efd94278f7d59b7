#pragma once

#include <functional>
#include <memory>

#include "mechanics/motion/orbit.hpp"

namespace mechanics::inline motions {

/// Systems, and what is to come back of them, by a parameter.
struct OrbitFamily {
  std::function<std::unique_ptr<const LagrangianSystem>(double)> system;
  std::function<OrbitQuestion(const LagrangianSystem&, double)> question;
  double range = 1;  ///< how far values go: near the value 0 differences and what is settled are parts of it
};

/// An orbit at which a branch over the parameter turns around: a fold.
struct TurningPoint {
  double value = 0;  ///< of the parameter
  Orbit orbit;
  Vector along;  ///< the direction in which q and v at the start go there, of length 1: 2n
};

/// Newton's method on the extended system map(x, p) = x, g(x, p) = 0, where g is the last entry of the
/// solution of [J b; cᵀ 0] (v; g) = (0; 1), J = ∂map/∂x - 1, which is 0 where J is singular (Griewank and
/// Reddien 1984; Govaerts 2000, section 4.1). J is exact; derivatives of J and by p, which only speed it up,
/// are differences. near: an orbit at `value`. Nothing where it does not arrive, leads further than `reach`
/// from that value, as where there is no fold, or p is known to less than ten digits. A free period T is one
/// unknown more, and the phase one equation more, J = [∂map/∂x - 1, x'; x'ᵀ, 0]; nothing then for orbits that
/// come in families by their energy.
std::optional<TurningPoint> find_turning_point(const OrbitFamily& family, double value, const Orbit& near,
                                               double reach);

/// The orbit with along·(x - x of the fold) = distance, at whatever value of the parameter: on one side of
/// the fold or the other by the sign of the distance.
struct OrbitBeside {
  double value = 0;
  Orbit orbit;
};
std::optional<OrbitBeside> orbit_beside(const OrbitFamily& family, const TurningPoint& fold, double distance);

}  // namespace mechanics::inline motions
