#pragma once

#include "convex/vector.hpp"

namespace convex::atlas {

/// A probability with a bound on its error that holds. `closed`: by a closed form, of which rounding is the
/// only error; else by quadrature in interval arithmetic, of which rounding and truncation are bounded.
struct Probability {
  double value = 0, error = 0;
  bool closed = true;
};

Probability operator*(const Probability&, const Probability&);
/// Adds sign p.
void add(Probability& sum, int sign, const Probability& p);
/// What came out negative, within its error, counts as 0.
Probability not_negative(Probability p);

/// Normal variables of variance 1 and any mean; b: k means, angles: k×k, the correlation of i and j is
/// cos(angles_ij). Angles rather than correlations, for these tell thin cones badly. Means and angles may be
/// off by eight units of the last place, but 0 and pi/2 are what they say.
struct NormalVariables {
  Vector mean;
  Matrix angles;
};

inline constexpr Index most_variables = 6;

/// The probability that all of them are >= 0, at most `most_variables`. Centred, up to three of them, it is
/// the solid angle of a simplicial cone: (pi - θ)/2pi, (2pi - θ_12 - θ_13 - θ_23)/4pi (Girard). Else one
/// variable is made independent of the others along a straight line of correlation matrices, and what that
/// changes is integrated (Plackett 1954): by Gauss' rules with a proved error, in interval arithmetic. The
/// error is at most `tolerance` unless rounding alone is more; it tells.
Probability orthant_probability(const NormalVariables&, double tolerance);

}  // namespace convex::atlas
