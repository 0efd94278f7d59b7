#pragma once

#include "convex/sets/subdifferential.hpp"

/// Sets of subgradients and what is done with them: each is a polyhedron in fractions, or known by its
/// support function, as an expression of the language in the plain product.
namespace convex::inline sets::subgradients {

Subdifferential of_polyhedron(ExactPolyhedron P, bool is_exact);
/// {v}, nothing, and {t d : t >= 0}.
Subdifferential single(const Fractions& v, bool is_exact);
Subdifferential none(std::size_t n);
Subdifferential ray(const Fractions& d, bool is_exact);
/// The closed convex set with this support function, a Call of a positively homogeneous function of n
/// entries.
Subdifferential of_support(Call support, std::size_t n, bool is_bounded);

/// Is the set, which is not empty, bounded? Then f is finite around x (Rockafellar 1970, theorem 23.4).
bool is_bounded(const Subdifferential&);

/// The sets {Aᵀv}, {v + w}, {(v, w)}, the closed convex hull of the union, and the intersection. A: by rows
/// of its nonzero entries, one an entry of v. What is empty stays so; the hull leaves it out.
Subdifferential transposed_image(const Subdifferential&, const std::vector<ExactRow>& A, std::size_t columns);
Subdifferential sum(const Subdifferential&, const Subdifferential&);
Subdifferential product(const std::vector<Subdifferential>&);
Subdifferential hull(const std::vector<Subdifferential>&);
Subdifferential intersection(const Subdifferential&, const Subdifferential&);

}  // namespace convex::inline sets::subgradients
