#pragma once

#include "convex/functions/node.hpp"

/// The atoms that operations on graph forms need, with closed conjugates among themselves.
namespace convex {

/// a·u.
std::shared_ptr<const Atom> linear_atom(const Vector& a);
/// ½|u|².
std::shared_ptr<const Atom> half_square_atom();
/// The indicator of {p}.
std::shared_ptr<const Atom> point_atom(const Vector& p);
/// The indicator of {u : u >= 0}.
std::shared_ptr<const Atom> orthant_atom();

/// a when f is `linear_atom(a)`, else null; is f `half_square_atom()`? The engine treats them exactly.
const Vector* slope_of(const Atom& f);
bool is_half_square(const Atom& f);

}  // namespace convex
