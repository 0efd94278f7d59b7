#pragma once

#include "convex/functions/decomposition.hpp"

/// Pairs of points that may be a split, with the right side of
///   ½ ||x - x*||² + ½ ||y - y*||² <= f(x) + g(y) - (x|y) + ½ ||z - x - y||²
/// (docs/theory.md, C.9) and how far it is known.
namespace convex::inline decompositions {

/// The values, products and sums of the right side are each right to so many roundings of their terms.
inline constexpr double roundings_of_a_term = 16;

/// x and y with what follows from them.
struct SplitCandidate {
  Decomposition split;
  double right = 0;           ///< the right side
  double error = 0;           ///< of f(x) and g(y)
  double squares = 0;         ///< ||z||², ||x||², ||y||², the largest
  double rounding = 0;        ///< of the terms
  bool open = false;          ///< the values are known together, and not each by itself
  bool x_is_outside = false;  ///< f(x) is that of a point beside x: x itself is outside, or may be

  /// By how much the right side leaves what the bound and rounding allow, the values taken as exact: their
  /// errors would hide that of a point, which the right side has squared. +inf where a value is not finite.
  double excess() const;
  /// The bound of ||x - x*|| and ||y - y*|| that the right side is; below 0 it says that a value is too small
  /// by as much, and may be as large.
  double proved() const;
  /// Are f(x) + g(y) and (x|y) one, and known, to the tolerance?
  bool known(double tolerance) const;
  /// Is g(y) known to a part of itself, and not only as far as the rounding of a far z leaves it?
  bool knows_g() const;
};

/// f, its conjugate g in the metric's product, and the plain one.
struct SplitFunctions {
  const Function &f, g, plain;
};

/// ||x - x*|| and ||y - y*|| are at most this: by their own bounds, and where these add up to less than the
/// residual ||z - x - y||, so that one of them is wrong, by the other and the residual. No less than the
/// residual: were one of the points right, it would be the error of the other.
double bound_with_residual(const Decomposition& split);

/// The right side at x and y themselves.
SplitCandidate at_points(const SplitFunctions& of, Prox x_part, Prox y_part, const Vector& z,
                         const Metric& W);

/// The right side at x and the covector v of its prox. No y of doubles has a g(y) near that of the exact one
/// where Wy cancels, as where |z| is far above |v|; W⁻¹v, of which y is a rounding, has: g(W⁻¹v) = f*(v). The
/// right side then proves the pair x and W⁻¹v, and the distance of y from there is added to its bound.
///
/// Where the domain of f or f* is thin, as a plane, x or v of doubles is outside it by rounding, and counts
/// as inside; x·v is then that of a point beside it. Where r = W(x - z) + v is the rounding of its terms,
/// (x|y) is taken at x - W⁻¹r or at v - r, which make up z exactly, when this agrees better with the values.
SplitCandidate at_covector(const SplitFunctions& of, Prox x_part, Prox y_part, const Vector& z,
                           const Metric& W, double tolerance);

/// The right side at x and z - x, one of which is 0, so that (x|y) is 0 and has no rounding: however the
/// point was found, the values prove it. The bound is what they prove, and the slack by which a point of
/// doubles counts as inside a domain. None where the value at 0 alone leaves more open than `enough`.
std::optional<SplitCandidate> at_zero(const SplitFunctions& of, const Vector& x, const Vector& z,
                                      const Metric& W, double enough);

/// f(x); +inf, which contradicts nothing, where it is not told.
Value told_value(const Function& f, const Vector& x);

/// Where f or g is the indicator of a set: does that hold the middle between z and what is told as its point
/// nearest to z, which is farther away than its bound and the slack of membership? Then it is not the
/// nearest.
bool holds_nearer_point(const SplitFunctions& of, const Decomposition& split, const Vector& z,
                        const Metric& W);

/// What a rounding of x makes of f(x), to first order: |v|·|x| for a subgradient there.
double size_of_slope(const Function& f, const Vector& x);

/// Is (x|y) that of the points x and y, as far as the tolerance and their rounding leave it?
bool is_inner_of_points(const Decomposition& split, double tolerance, const Metric& W);

}  // namespace convex::inline decompositions
