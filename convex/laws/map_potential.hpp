#pragma once

#include "convex/laws/map_laws.hpp"
#include "convex/symbolic/exact_curve.hpp"

namespace convex::inline law_checks {

/// From where to where a map of one variable is looked at: the box, and a box's length beyond each kink.
std::pair<Fraction, Fraction> seen_range(const Map& T, double low, double high);

/// The pieces of a map of one variable that is affine between a few points, where fractions show it to be
/// that at points of a grid and at others between them; the first and the last go on for ever. None where it
/// is not so seen: sampling proves nothing, and where kinks are not known a bend may hide between two points.
std::optional<std::vector<symbolic::AffinePiece>> seen_pieces(const Map& T, double low, double high);

/// The map through points of increasing z, affine between them and beyond.
std::vector<symbolic::AffinePiece> joined_pieces(const std::vector<Fraction>& z,
                                                 const std::vector<Fraction>& Tz);

/// f at p = T z, of the f with T = prox_f, if there is one: f(T z) = (z|T z) - phi(z) - ½||T z||², where
/// phi(z) = ∫ (T(tz)|z) dt over [0, 1] is the convex function that T is the subgradient of (Moreau 1965); so
/// that phi(0) = 0. `error`: that of the quadrature, estimated.
struct PotentialPoint {
  Vector z, p;
  double f = 0, error = 0;
};
/// On a grid of so many points along each coordinate; none where T has no value on the way.
std::vector<PotentialPoint> potential(const Map& T, const ExactMetric& W, double low, double high,
                                      Index along);

}  // namespace convex::inline law_checks
