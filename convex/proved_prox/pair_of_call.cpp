#include "convex/proved_prox/pair_of_call.hpp"

#include "convex/exact_program/program_of_call.hpp"
#include "convex/proved_prox/proved_metric.hpp"

namespace convex {

PairSearch pair_of_call(const Call& f, const ExactGram& W, const Vector& x, const Vector& v) {
  if (const auto program = exact_program(f, W)) {
    if (auto at = near_graph_point(*program, x + v)) return {proof_pair(std::move(*at)), {}};
    return {std::nullopt, "doubles do not find the active rows of " + f.name};
  }
  return {std::nullopt, f.name + " has no formula in balls yet"};
}

}  // namespace convex
