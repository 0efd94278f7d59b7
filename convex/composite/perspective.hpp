#pragma once

#include "convex/composite/atom.hpp"

namespace convex::inline composite {

/// The perspective (x, s) -> s f(x/s) for s > 0; its closure, the recession function of f, at s = 0; +inf for
/// s < 0, as an atom of n + 1 entries, the last being s / side, side not 0. n is the number of entries of x.
///
/// It is the support function of {(v, r) : f*(v) <= -r} (Rockafellar 1970, Corollary 13.5.1), so that
/// Moreau's identity gives its prox in d times the identity at (z, s): with q = dz and p = prox_{f/mu}(q/mu),
///   (x, s) = mu/d (p, 1),  mu >= 0 the root of side² (f(p) - p·(q - mu p)) + mu = d s.
/// At s = 0 the value is the limit of difference quotients; +inf where they do not settle.
std::shared_ptr<const Atom> perspective_atom(std::shared_ptr<const Atom> f, Index n, double side = 1);

}  // namespace convex::inline composite
