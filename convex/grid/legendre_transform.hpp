#pragma once

#include "convex/grid/grid_function.hpp"

namespace convex::inline grids {

/// g(s) = max_x s·x - f(x) over the points x of the grid, on the grid of slopes: the linear-time Legendre
/// transform, dimension by dimension (Lucet 1997, "Faster than the fast Legendre transform, the linear-time
/// Legendre transform"), O(n + m) for each line of n points and m slopes. f need not be convex.
///
/// The maximum is right to rounding, u (|s·x| + |f(x)|) at the best point and a few times that. It is the
/// conjugate of the sampled function and of its convex hull, in one dimension of the piecewise linear
/// interpolant of a convex f. A function of which f holds samples has a conjugate at least g; where its
/// maximiser lies within the grid and its gradient has Lipschitz constant l there, larger by at most l/8
/// sum_k h_k², h_k the steps around the maximiser. Throws InvalidInput as `validate` does.
GridFunction conjugate(const GridFunction& f, const std::vector<Vector>& slopes);

/// min_x f(x) + ||x - p||²/(2 gamma) over the points x of the grid, on the grid of points p: the Moreau
/// envelope in the plain metric, by the same hulls and merges (parabolic envelope: Felzenszwalb and
/// Huttenlocher 2012), without the cancellation of ||p||²/(2 gamma) - conjugate. Right to rounding; an
/// envelope of which f holds samples is at most this and smaller by at most (l + 1/gamma)/8 sum_k h_k². gamma
/// > 0.
GridFunction envelope(const GridFunction& f, double gamma, const std::vector<Vector>& points);

}  // namespace convex::inline grids
