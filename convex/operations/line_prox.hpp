#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// The prox of a function of one entry in the metric w, from subgradients of f alone: w (x - z) + v increases
/// with x, whatever the v in ∂f(x), and the doubles between which its sign changes are found by halving their
/// number, be the prox 1e-200 from the end of the domain. v is W(z - x), as far as it lies between the
/// subgradients at the two. None where the domain of f is not known, or a subgradient on the way.
std::optional<Prox> line_prox(const Function& f, double z, double w);

}  // namespace convex::inline operations
