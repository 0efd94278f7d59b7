#pragma once

#include <optional>
#include <vector>

#include "convex/exact_program/exact_program.hpp"
#include "convex/proved_prox/pair_of_call.hpp"

/// Pairs of f_1 + f_2 + …, whose parts share a point.
namespace convex::inline proved_prox {

/// Where both parts have corners: a program and a ball, or the norm that supports one.
struct ProgramAndBall {
  ExactProgram P;
  Fraction radius;
  Fractions centre;
  std::size_t program, ball;  ///< which parts they are
};

/// The first of each among the parts, the conjugates of both where `conjugate`; none without.
std::optional<ProgramAndBall> program_and_ball(const std::vector<Call>& parts, bool conjugate,
                                               const ExactGram& W);

/// Of a program at x, with the subgradient nearest to v: that of a short step along v.
PairSearch program_pair_towards(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v);

/// Near x and v.
PairSearch pair_of_sum(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v);
/// At x itself: of each gradient, so that the covectors add up.
PairSearch sum_at_point(const Call& f, const ExactGram& W, const Fractions& x);
/// At v itself, near x: one part takes what the gradients of the others leave of v.
PairSearch sum_at_covector(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v);

}  // namespace convex::inline proved_prox
