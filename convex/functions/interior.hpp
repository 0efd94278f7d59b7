#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline named_functions {

/// Is x inside the domain of f, by far more than `membership_tolerance` of `size` leaves open? Where a domain
/// made larger by that holds a larger ball about x, it holds x itself. Asked by two values for each entry;
/// not of many.
bool is_well_inside(const Function& f, const Vector& x, double size);

/// Is an entry of x beyond all of the domain of f, by more than `membership_tolerance` of `size` and of x?
bool is_beyond_domain(const Function& f, const Vector& x, double size);

}  // namespace convex::inline named_functions
