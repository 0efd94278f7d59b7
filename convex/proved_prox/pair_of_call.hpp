#pragma once

#include <string>

#include "convex/proved_prox/proof_pair.hpp"

namespace convex {

/// A pair near a point x and a covector v of doubles, or why there is none.
struct PairSearch {
  std::optional<ProofPair> pair;
  std::string why_none;
};

/// For the function that a call means in the product of W: from its program in fractions where it has one,
/// else from the formulas of f and f* in balls.
PairSearch pair_of_call(const Call& f, const ExactGram& W, const Vector& x, const Vector& v);

}  // namespace convex
