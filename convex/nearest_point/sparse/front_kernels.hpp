#pragma once

#include "convex/vector.hpp"

namespace convex::inline sparse {

/// The dense work of a multifrontal factorisation, column-major, lower triangles only.

/// Factors the first `columns` columns of a panel with `rows` rows: its upper block becomes L (unit diagonal
/// not stored, the diagonal keeps D), what is below becomes L too. False when a pivot is 0 or not finite.
bool factor_panel(double* panel, Index rows, Index columns);

/// C -= L D Lᵀ, C: size×size, of which the lower triangle is touched; L: the last `size` rows of a factored
/// panel.
void subtract_outer(double* C, Index size, const double* panel, Index rows, Index columns);

}  // namespace convex::inline sparse
