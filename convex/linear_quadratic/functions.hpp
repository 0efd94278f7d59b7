#pragma once

#include "convex/linear_quadratic/linear_quadratic.hpp"

/// The piecewise linear-quadratic functions of docs/functions.md on n entries, each with the fewest auxiliary
/// variables that keep its data as they are. Weights are >= 0. Each throws InvalidInput when its data are not
/// finite or do not fit, or the function would not be convex.
namespace convex::linear_quadratic {

LinearQuadratic zero(Index n);
LinearQuadratic constant(Index n, double value);
/// c·x.
LinearQuadratic linear(const Vector& c);
/// ½ x·Qx + c·x, Q symmetric positive semidefinite to the rounding of its entries.
LinearQuadratic quadratic(const Matrix& Q, const Vector& c);
/// weight/2 ||x||².
LinearQuadratic squared_norm2(Index n, double weight);
/// weight Σ |x_i|.
LinearQuadratic norm1(Index n, double weight);
/// weight max |x_i|.
LinearQuadratic norm_inf(Index n, double weight);
/// Σ x²/(2 mu) where |x| <= mu, else |x| - mu/2; mu > 0 (Huber 1964).
LinearQuadratic huber(Index n, double mu);
/// max x_i, n >= 1.
LinearQuadratic max(Index n);
/// The sum of the `count` largest entries, 1 <= count <= n: min over t of count t + Σ max(0, x_i - t)
/// (Rockafellar and Uryasev 2000).
LinearQuadratic sum_largest(Index n, Index count);
/// max_i a_i·x + b_i over the rows of A, at least one.
LinearQuadratic max_affine(const Matrix& A, const Vector& b);
/// Σ max(0, 1 - x_i).
LinearQuadratic hinge(Index n);
/// Σ max(0, 1 - x_i)².
LinearQuadratic squared_hinge(Index n);
/// l1 ||x||_1 + l2/2 ||x||².
LinearQuadratic elastic_net(Index n, double l1, double l2);
/// weight Σ |x_{i+1} - x_i|.
LinearQuadratic total_variation(Index n, double weight);
/// sup over y in the set of x·y, `set` the indicator of a polyhedron.
LinearQuadratic support(const LinearQuadratic& set);

/// Σ_i p(x_i) with p piecewise quadratic: c2/2 x² + c1 x + c0 on the piece of each row [c2, c1, c0], pieces
/// divided by increasing breaks; a first or last row [inf, 0, 0] is +inf there. breaks: k; coefficients:
/// (k+1)×3. One auxiliary variable an entry for each finite piece but the one with the minimum: how far x
/// goes into that piece, as costs rise from piece to piece (and one more when the minimum lies in a curved
/// piece). Throws InvalidInput when p is not continuous and convex where it is finite.
LinearQuadratic separable_pieces(Index n, const Vector& breaks, const Matrix& coefficients);

}  // namespace convex::linear_quadratic
