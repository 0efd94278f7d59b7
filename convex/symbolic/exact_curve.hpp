#pragma once

#include <optional>
#include <vector>

#include "convex/symbolic/surd.hpp"

namespace convex::symbolic {

/// A convex, closed, proper, piecewise linear-quadratic function of one variable in exact numbers, kept as
/// the graph of its subdifferential: a monotone line through corners, from a ray to a ray, as
/// `convex::PiecewiseQuadratic` keeps it in doubles. There is at least one corner; corners increase, x and y
/// both, and are never equal. Rays have directions (run, rise), both >= 0, not both 0.
struct ExactCurve {
  std::vector<Surd> x, y;
  Surd left_run, left_rise, right_run, right_rise;
  Surd value;  ///< f at x.front()

  std::size_t corners() const { return x.size(); }
};

/// One piece c2/2 x² + c1 x + c0; an end that is not there is infinite.
struct ExactPiece {
  std::optional<Surd> low, high;
  Surd c2, c1, c0;
};

/// Increasing and adjoining; +inf outside of them.
std::vector<ExactPiece> pieces(const ExactCurve&);
/// Throws InvalidInput when they do not adjoin, jump, or are not convex.
ExactCurve exact_curve(const std::vector<ExactPiece>&);

/// f(x); none where it is +inf.
std::optional<Surd> value(const ExactCurve&, const Surd& x);

/// f*(y) = sup xy - f(x): x and y exchanged.
ExactCurve conjugate(const ExactCurve&);
/// inf_u f(u) + (x - u)²/(2 gamma), gamma > 0.
ExactCurve envelope(const ExactCurve&, const Fraction& gamma);
/// alpha f, alpha > 0; f(x/rho), rho not 0; f(x - by); f + cx; f + c.
ExactCurve scale(const ExactCurve&, const Fraction& alpha);
ExactCurve dilate(const ExactCurve&, const Fraction& rho);
ExactCurve translate(const ExactCurve&, const Fraction& by);
ExactCurve tilt(const ExactCurve&, const Fraction& c);
ExactCurve add_constant(const ExactCurve&, const Fraction& c);
/// Throws InvalidInput when the domains do not meet.
ExactCurve sum(const ExactCurve&, const ExactCurve&);
/// inf_u f(u) + g(x - u) = (f* + g*)*. Throws InvalidInput when it is identically -inf.
ExactCurve inf_convolution(const ExactCurve&, const ExactCurve&);

/// max(f(x), g(x)). Pieces cross at fractions or at a + b sqrt(c). Throws InvalidInput when the domains do
/// not meet, or a root would stand under another one.
ExactCurve pointwise_max(const ExactCurve&, const ExactCurve&);

/// A piece slope z + offset for low <= z <= high.
struct AffinePiece {
  std::optional<Surd> low, high;
  Surd slope, offset;
};
/// prox of gamma f, gamma > 0: z = x + gamma y goes to x.
std::vector<AffinePiece> prox_pieces(const ExactCurve&, const Fraction& gamma);
/// The function whose prox is the map with these pieces, which adjoin and fill the line; none when the map
/// falls somewhere or has a slope above 1. Its value is 0 where a piece begins first (or at the map of 0).
std::optional<ExactCurve> function_of_prox(const std::vector<AffinePiece>&);

/// The fraction of least denominator that rounds to the double: 0.1 is 1/10, 1/3 as read is 1/3.
Fraction simplest_fraction(double value);

}  // namespace convex::symbolic
