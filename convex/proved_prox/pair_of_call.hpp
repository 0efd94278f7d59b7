#pragma once

#include <functional>
#include <string>

#include "convex/proved_prox/proof_pair.hpp"

namespace convex::inline proved_prox {

/// A pair near a point x and a covector v, or why there is none.
struct PairSearch {
  std::optional<ProofPair> pair = {};
  std::string why_none = {};
};

/// For the function that a call means in the product of W: from its program in fractions where it has one,
/// else from the formulas of f and f* in balls, operation by operation. x, v: as many entries as W.
PairSearch pair_of_call(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v);

/// A pair with this x exactly, v by choice: where the function is differentiable, or strictly inside a set.
PairSearch pair_at_point(const Call& f, const ExactGram& W, const Fractions& x);
/// A pair with this v exactly.
PairSearch pair_at_covector(const Call& f, const ExactGram& W, const Fractions& v);
/// The same where x near the supremum of x·v - f(x) is known, from which that of an operation is found whose
/// parts choose theirs by it.
PairSearch pair_at_covector(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v);

/// How a pair of a part is found: near x and v, or with one of them exactly, whatever the other is.
using PairOfPart =
    std::function<PairSearch(const Call& part, const ExactGram& W, const Fractions& x, const Fractions& v)>;

/// Of separable, indicator, translate, tilt, scale and dilate, by the pairs of their parts; none of others.
std::optional<PairSearch> pair_by_change_of_variables(const Call& f, const ExactGram& W, const Fractions& x,
                                                      const Fractions& v, const PairOfPart& pair_of);

/// Of sum, intersection, inf_convolution, pointwise_max and precompose, whose parts must share a point or a
/// covector without rounding.
PairSearch pair_of_combination(const Call& f, const ExactGram& W, const Fractions& x, const Fractions& v);
/// Of sum, intersection, pointwise_max and precompose with this x exactly.
PairSearch combination_at_point(const Call& f, const ExactGram& W, const Fractions& x);
/// Of inf_convolution with this v exactly.
PairSearch combination_at_covector(const Call& f, const ExactGram& W, const Fractions& v);
/// Of all of them with this v exactly and x near the point; none where no such pair is found.
PairSearch combination_near_covector(const Call& f, const ExactGram& W, const Fractions& x,
                                     const Fractions& v);

}  // namespace convex::inline proved_prox
