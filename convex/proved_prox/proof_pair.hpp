#pragma once

#include <optional>

#include "convex/exact_program/exact_minimum.hpp"
#include "convex/gamma0/call.hpp"

namespace convex::inline proved_prox {

/// A number that lies in [low, high].
struct FractionInterval {
  Fraction low, high;
};

/// A point x and a covector v, fractions both, at which f and its plain conjugate f* are enclosed. Nothing is
/// assumed of how they were found; what they prove follows from the values alone (see `proved_radius`).
struct ProofPair {
  Fractions x, v;
  FractionInterval f_x, f_v;
  bool is_rational = false;  ///< no balls took part
};

ProofPair proof_pair(GraphPoint at);
/// The same of the conjugate: x and v change places.
ProofPair turned_round(ProofPair pair);

/// An upper bound of f(x) + f*(v) - x·v, which is >= 0 (Fenchel 1949).
Fraction gap_above(const ProofPair& pair);

}  // namespace convex::inline proved_prox
