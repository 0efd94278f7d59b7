#pragma once

#include "convex/vector.hpp"

namespace convex::linear_algebra {

/// The dense work of a multifrontal factorisation, column-major, lower triangles: what stands above a diagonal
/// is nobody's, and may be written.

/// Factors the first `columns` columns of a panel with `rows` rows: its upper block becomes L (unit diagonal
/// not stored, the diagonal keeps D), what is below becomes L too. False when a pivot is 0 or not finite.
bool factor_panel(double* panel, Index rows, Index columns);

/// C = -L D Lᵀ, C: size×size, of which the lower triangle is written; L: the last `size` rows of a factored
/// panel.
void outer_product(double* C, Index size, const double* panel, Index rows, Index columns);

/// Adds columns from … to - 1 of the lower triangle of an update, size×size: its entry (i, j) to the number
/// target[place_j stride + place_i]. place: growing.
void add_columns(const double* update, Index size, Index from, Index to, const int* place, double* target,
                 Index stride);

/// So many numbers beyond a panel, which are to be finite, and beyond x below, which are to be 0, are read.
inline constexpr Index read_beyond = 8;

/// x, one number a row of a factored panel, 0 below its columns: there L⁻¹x; below what that adds to the
/// rows.
void forward_panel(const double* panel, Index rows, Index columns, double* x);

/// x, one number a row of a factored panel, below its columns the solution: there that too, of D Lᵀ.
void backward_panel(const double* panel, Index rows, Index columns, double* x);

}  // namespace convex::linear_algebra
