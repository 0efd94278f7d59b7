#include "convex/proved_prox/proof_pair.hpp"

namespace convex::inline proved_prox {

ProofPair proof_pair(GraphPoint at) {
  return {std::move(at.x), std::move(at.v), {at.f_x, at.f_x}, {at.f_v, at.f_v}, true};
}

ProofPair turned_round(ProofPair pair) {
  std::swap(pair.x, pair.v);
  std::swap(pair.f_x, pair.f_v);
  return pair;
}

Fraction gap_above(const ProofPair& pair) { return pair.f_x.high + pair.f_v.high - dot(pair.x, pair.v); }

}  // namespace convex::inline proved_prox
