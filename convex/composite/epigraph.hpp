#pragma once

#include "convex/functions/node.hpp"

namespace convex {

/// The indicator of epi f = {(x, t) : f(x) <= t} as an atom of n + 1 entries, t last.
///
/// Its projection is (prox_{mu f} z, s + mu) with mu >= 0 the root of f(prox_{mu f} z) = s + mu, whose left
/// side decreases in mu (Bauschke and Combettes 2017, Proposition 29.35): safeguarded Newton steps, the slope
/// being -1 - v·Jv for v = (z - x)/mu and J the Jacobian of the prox. n is the number of entries of x.
std::shared_ptr<const Atom> epigraph_atom(std::shared_ptr<const Atom> f, Index n);

/// The perspective (x, s) -> s f(x/s), s > 0; its closure, the recession function of f, at s = 0; +inf for
/// s < 0, as an atom of n + 1 entries, s last. It is the support function of {(v, r) : f*(v) <= -r}
/// (Rockafellar 1970, Corollary 13.5.1), so that Moreau's identity gives its prox.
std::shared_ptr<const Atom> perspective_atom(std::shared_ptr<const Atom> f, Index n);

}  // namespace convex
