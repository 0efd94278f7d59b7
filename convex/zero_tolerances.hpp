#pragma once

namespace convex {

// Parts of their largest terms below which sums count as 0: what rounding leaves of them. They choose what is
// looked at more closely; where a sign decides, it is taken without rounding.

/// Of a few terms in twice the working precision, u² = 2⁻¹⁰⁶ each, as in a slack.
inline constexpr double zero_of_pairs = 0x1p-95;

/// Of up to 2¹⁶ terms in twice the working precision, as along a chain.
inline constexpr double zero_of_long_sums = 0x1p-90;

/// Of coefficients of a row in terms of others, found in doubles.
inline constexpr double zero_coefficient = 1e-9;

/// A slack in doubles that is closer to 0 is computed again in twice the working precision.
inline constexpr double near_zero = 1e-8;

/// Of sums in doubles that make up Aq - z, or q.
inline constexpr double zero_in_doubles = 0x1p-44;

/// The same where z was rounded before it came.
inline constexpr double zero_where_z_is_rounded = 0x1p-40;

/// Rows that are 0 together within their radii alone exclude motions up to so many times the scale: it is how
/// large an answer may be, not what is dependent (docs/methods/decisions-without-rounding.md).
inline constexpr double farthest_motion = 1e3;

}  // namespace convex
