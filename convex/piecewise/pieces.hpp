#pragma once

#include "convex/piecewise/piecewise_quadratic.hpp"
#include "convex/vector.hpp"

namespace convex::inline piecewise_quadratics {

/// A piecewise linear-quadratic function as `plq(breaks, coefficients)` of docs/functions.md writes it.
struct Pieces {
  Vector breaks;        ///< k, increasing
  Matrix coefficients;  ///< (k+1)×3: row i is [c2, c1, c0], c2/2 x² + c1 x + c0 on piece i, or [inf, 0, 0]
};

/// How much of the largest term of either piece two pieces may miss each other by at a break, in value and,
/// downwards, in slope, and count as joined: coefficients are often written with twelve digits. Each piece
/// keeps its own coefficients; a larger jump is refused.
inline constexpr double joint_tolerance = 1e-10;

/// The function with these pieces. The value at the end of the domain is that of the finite piece. A finite
/// piece between two equal breaks, with +inf on both sides, is a point. Throws InvalidInput naming the piece
/// or break when sizes do not match, breaks do not increase, a number is not finite, or the function is not
/// convex (c2 < 0, a jump, a slope that falls, +inf between finite pieces) or +inf everywhere.
PiecewiseQuadratic piecewise_quadratic(const Vector& breaks, const Matrix& coefficients);

/// The pieces of f. Of what `piecewise_quadratic` made they are the same bytes as were given, but for -0 and
/// breaks between two equal rows. In general each coefficient is rounded; far from 0 a translated function
/// is told more accurately by its curve. Throws InvalidInput when a coefficient overflows.
Pieces pieces(const PiecewiseQuadratic& f);

}  // namespace convex::inline piecewise_quadratics
