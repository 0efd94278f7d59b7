#pragma once

#include <span>
#include <vector>

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// The parts of a sum on n entries, without the bounds on entries that the domain of another part implies:
/// beside Σ x_i log x_i the orthant goes, and of the simplex its hyperplane is left. Where x comes
/// near such a bound, two parts would hold it there, one of them steeply, and a program in both does not tell
/// how much each does. Of a set of which more than one row would be left, nothing is taken.
std::vector<Function> without_implied_bounds(std::span<const Function> parts, Index n);

}  // namespace convex::inline operations
