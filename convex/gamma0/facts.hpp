#pragma once

namespace convex::inline gamma0 {

/// What is known of a function f in Gamma_0; rules and fallbacks use it. A fact that is not known is false.
struct Facts {
  bool indicator = false;  ///< takes the values 0 and +inf alone: the indicator of a closed convex set
  bool cone = false;       ///< the indicator of a closed convex cone
  bool support = false;    ///< positively homogeneous with f(0) = 0: the support function of a set
  bool separable = false;  ///< a sum of functions of one entry each
  bool piecewise_quadratic = false;  ///< piecewise linear-quadratic: its prox is exact in any metric
  bool smooth = false;               ///< differentiable wherever it is finite
  bool finite = false;               ///< finite everywhere
  bool radial = false;               ///< a nondecreasing function of ||x||₂
  /// The order of the entries alone decides on its slopes: ∂f(u) lies in ∂f at (p(u_1), …, p(u_n)) for every
  /// nondecreasing p. So for the support functions of base polytopes (Bach 2013, section 8), such as max and
  /// total_variation.
  bool by_order = false;
};

/// A point x belongs to a set, and f(x) is finite at the rounded x, when x misses the set by at most this
/// part of the scale of x and of the set's data. The one membership tolerance of the convex layer: a
/// projection is rounded, and an indicator at a rounded projection must not be +inf.
inline constexpr double membership_tolerance = 1e-9;

/// What every prox aims at: ||x - x*||_W <= this (||z||_W + ||x||_W), in metrics of condition up to 1e6.
inline constexpr double accuracy_of_prox = 1e-12;

}  // namespace convex::inline gamma0
