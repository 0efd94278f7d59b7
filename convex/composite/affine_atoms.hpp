#pragma once

#include "convex/composite/atom.hpp"

/// The atoms that operations on graph forms need, with closed conjugates among themselves.
namespace convex::inline composite {

/// a·u.
std::shared_ptr<const Atom> linear_atom(const Vector& a);
/// ½ u·Qu + c·u + constant, Q positive semidefinite.
std::shared_ptr<const Atom> quadratic_atom(QuadraticForm form);
/// ½|u|².
std::shared_ptr<const Atom> half_square_atom();
/// The indicator of {p}.
std::shared_ptr<const Atom> point_atom(const Vector& p);
/// The indicator of {u : u >= 0}.
std::shared_ptr<const Atom> orthant_atom();

}  // namespace convex::inline composite
