#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline named_functions {

/// The decomposition of a point (Moreau 1965): z = x + y and f(x) + g(y) = (x|y), where x = prox_f z,
/// y = prox_g z and g(y) = sup_x (x|y) - f(x) is the conjugate in the metric. y is computed as the prox of
/// the function g, never as z - x.
///
/// The answer is held against the values of f and g. Whatever the points x and y, and however they were
/// found,
///   ½ ||x - x*||² + ½ ||y - y*||² <= f(x) + g(y) - (x|y) + ½ ||z - x - y||²
/// in the metric: add f(x) >= f(x*) + (y*|x - x*) and g(y) >= g(y*) + (x*|y - y*). A right side above the
/// square of the bound, or below 0, by more than the rounding of its terms, says that a bound or a value is
/// wrong. See docs/theory.md, C.9.
struct Decomposition {
  Prox x, y;
  /// Values at x and y, or at what x and y are roundings of: x and a covector v of f there, g(W⁻¹v) = f*(v).
  double f_x = 0, g_y = 0;
  double inner = 0;        ///< (x|y) = x·Wy; f(x) + g(y), which it equals, where its terms cancel more
  double fenchel_gap = 0;  ///< f(x) + g(y) - (x|y), >= 0 but for rounding (Fenchel 1949)
  double residual = 0;     ///< ||z - x - y||_W
  /// ||x - x*||_W and ||y - y*||_W are at most this: the larger of the two proxes' own bounds and the
  /// residual; where the bounds do not explain the residual, for it is more than their sum, the other point's
  /// error as the residual tells it, whichever of the two bounds holds; and where the right side above is too
  /// large, the root of twice what it is at most. A point that rounding left outside the domain was moved
  /// into it, by as much more. Where the values prove more than the proxes know of themselves, it is what
  /// they prove.
  double error_bound = 0;
  /// `solved`: the error bound is at most tolerance * max(1, ||z||_W, ||x||_W), f(x) and g(y) are known and
  /// add up to (x|y) within tolerance * max(|f(x)|, |g(y)|, |(x|y)|, 1e-3), and the right side above agrees
  /// with the bound.
  Status status = Status::gave_up;
};

}  // namespace convex::inline named_functions

/// It takes proxes of operations and fractions, in rooms above this one.
namespace convex::inline decompositions {

/// z: as many entries as W. Throws InvalidInput when f has another number, or z is not finite.
Decomposition decompose(const Function& f, const Vector& z, const Metric& W, double tolerance = 1e-9);

}  // namespace convex::inline decompositions
