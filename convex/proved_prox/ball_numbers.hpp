#pragma once

#include "convex/exact/ball.hpp"
#include "convex/proved_prox/proof_pair.hpp"

/// Numbers of proofs: balls for what is not rational, fractions for everything else.
namespace convex::inline proved_prox {

/// Bits that witnesses are made with, and bits that they are looked at with: the second resolves what the
/// first leaves.
inline constexpr long witness_bits = 256, proof_bits = 512;

inline Ball ball(const Fraction& a) { return Ball::of(a, proof_bits); }
inline Ball operator+(const Ball& a, const Ball& b) { return Ball::apply(BallFunction::add, a, b); }
inline Ball operator-(const Ball& a, const Ball& b) { return Ball::apply(BallFunction::subtract, a, b); }
inline Ball operator*(const Ball& a, const Ball& b) { return Ball::apply(BallFunction::multiply, a, b); }
inline Ball operator/(const Ball& a, const Ball& b) { return Ball::apply(BallFunction::divide, a, b); }
inline Ball log(const Ball& a) { return Ball::apply(BallFunction::log, a); }
inline Ball exp(const Ball& a) { return Ball::apply(BallFunction::exp, a); }
inline Ball sqrt(const Ball& a) { return Ball::apply(BallFunction::sqrt, a); }
inline Ball pow(const Ball& a, const Ball& b) { return Ball::apply(BallFunction::power, a, b); }

/// All numbers of the ball; none when it is not finite.
std::optional<FractionInterval> interval(const Ball& a);

/// A number of the ball, rounded to `witness_bits`; none when it is not finite.
std::optional<Fraction> near(const Ball& a);
/// A dyadic number of `witness_bits` surely below (above) a positive one, by a part 2^-250.
Fraction a_little_below(const Ball& positive);
Fraction a_little_above(const Ball& positive);

/// Sums of intervals, factor >= 0.
FractionInterval operator+(const FractionInterval& a, const FractionInterval& b);
FractionInterval times(const Fraction& factor, const FractionInterval& a);
inline FractionInterval only(const Fraction& a) { return {a, a}; }

}  // namespace convex::inline proved_prox
