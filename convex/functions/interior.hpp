#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline named_functions {

/// Is x inside the domain of f, by far more than `membership_tolerance` of `size` leaves open? Where a domain
/// made larger by that holds a larger ball about x, it holds x itself. Asked by two values for each entry;
/// not of many.
bool is_well_inside(const Function& f, const Vector& x, double size);

}  // namespace convex::inline named_functions
