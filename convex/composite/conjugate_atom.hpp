#pragma once

#include "convex/composite/atom.hpp"

namespace convex::inline composite {

/// f* as an atom: f.conjugate() where that is one; else its value is that of f.conjugate() and its prox comes
/// from f's by Moreau's identity, prox^D_{f*} z = z - D⁻¹ prox^(D⁻¹)_f (D z). n is the number of entries.
std::shared_ptr<const Atom> conjugate_atom(std::shared_ptr<const Atom> f, Index n);

}  // namespace convex::inline composite
