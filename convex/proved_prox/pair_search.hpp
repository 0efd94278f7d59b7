#pragma once

#include "convex/proved_prox/ball_numbers.hpp"

/// Pairs of the functions that curve: witnesses are made in any way, their values looked at in fractions or
/// balls. Each returns none where the looking does not succeed.
namespace convex::inline proved_prox::pairs {

using MaybePair = std::optional<ProofPair>;

/// The candidate that leaves least open near (x, v).
MaybePair best_of(std::vector<MaybePair> candidates, const Fractions& x, const Fractions& v);

/// radius-ball about the centre, its indicator and support function: |x - c| <= radius, radius |v| + c·v.
MaybePair of_ball(const Fraction& radius, const Fractions& centre, const Fractions& x, const Fractions& v);
/// A pair of the ball at x strictly inside, or at v other than 0.
MaybePair ball_at_point(const Fraction& radius, const Fractions& centre, const Fractions& x);
MaybePair ball_at_covector(const Fraction& radius, const Fractions& centre, const Fractions& v);

/// P, piecewise linear-quadratic, and the indicator of the ball at one point of the sphere.
struct ProgramAndBallPairs {
  ProofPair P, ball;
};
std::optional<ProgramAndBallPairs> of_program_beside_ball(const ExactProgram& P, const Fraction& radius,
                                                          const Fractions& centre, const Fractions& x,
                                                          const Fractions& v);

/// Of two functions at one x the pair of their sum: (f + g)*(v + w) <= f*(v) + g*(w).
ProofPair sum_at_one_point(const ProofPair& f, const ProofPair& g);

/// log Σ e^x_i and Σ v_i log v_i on the simplex.
MaybePair of_log_sum_exp(const Fractions& x, const Fractions& v);
MaybePair log_sum_exp_at_point(const Fractions& x);

/// Of the closed cones K of three and more entries and their polars: f and f* are their indicators.
MaybePair of_second_order_cone(const Fractions& x, const Fractions& v);
MaybePair of_rotated_cone(const Fractions& x, const Fractions& v);
MaybePair of_exponential_cone(const Fractions& x, const Fractions& v);
MaybePair of_power_cone(const Fraction& alpha, const Fractions& x, const Fractions& v);
/// Of the cone of positive semidefinite matrices stacked by columns, and of -log det.
MaybePair of_psd_cone(const Fractions& x, const Fractions& v);
MaybePair of_neg_log_det(const Fractions& x, const Fractions& v);

/// Σ x_i².
Fraction square_of(const Fractions& x);
Fractions multiple_of(const Fraction& factor, Fractions x);
Fractions sum_of(const Fractions& x, const Fractions& y);

}  // namespace convex::inline proved_prox::pairs
