#pragma once

#include <optional>

#include "convex/composite/atom.hpp"

namespace convex::inline composite {

/// The indicator of {(x, t) : f(x) <= side t}, side not 0, as an atom of n + 1 entries, t last; the epigraph
/// of f when side is 1, its reflection when -1, in other units of height else. n is the number of entries of
/// x.
///
/// Its projection is (prox_{mu f} z, side (s + mu)) with mu >= 0 the root of f(prox_{mu f} z) = s + mu, whose
/// left side decreases in mu (Bauschke and Combettes 2017, Proposition 29.35), f/|side| for f where |side| is
/// not 1: safeguarded Newton steps, the slope being -1 - v·Jv for v = (z - x)/mu and J the Jacobian of the
/// prox. Its conjugate is the perspective of f*, `perspective_atom(f*, n, -1/side)`.
std::shared_ptr<const Atom> epigraph_atom(std::shared_ptr<const Atom> f, Index n, double side = 1);

/// What such an epigraph is made of; none where `set` is no epigraph.
struct EpigraphParts {
  std::shared_ptr<const Atom> f;
  double side = 1;
};
std::optional<EpigraphParts> parts_of_epigraph(const Atom& set);

}  // namespace convex::inline composite
