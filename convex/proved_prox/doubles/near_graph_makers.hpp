#pragma once

#include "convex/interval_arithmetic.hpp"
#include "convex/proved_prox/doubles/interval_arguments.hpp"
#include "convex/proved_prox/doubles/near_graph.hpp"

/// The formulas behind `near_graph`, by mechanism. Numbers of functions are intervals.
namespace convex::near_graphs {

using MaybeNear = std::optional<NearGraph>;

/// Separable functions of the catalogue: pieces of parabolas, and those with formulas of their slopes.
MaybeNear of_entries(const Call& f, const Vector& x, const Vector& v);

/// weight |x|₂, its subdifferential the ball of that radius.
NearGraph of_norm2(const Interval& weight, const Vector& x, const Vector& v);
/// weight |x|_p, 1 < p < inf.
MaybeNear of_norm_p(double p, const Interval& weight, const Vector& x, const Vector& v);
/// weight times the gauge of unit vectors with k entries (Argyriou, Foygel and Srebro 2012).
MaybeNear of_k_support(Index k, const Interval& weight, const Vector& x, const Vector& v);
MaybeNear of_log_sum_exp(const Vector& x, const Vector& v);
/// {(a, t) : |a|₂ <= t} and {(a, s, t) : |a|₂² <= 2 s t, s, t >= 0}.
MaybeNear of_second_order_cone(const Vector& x, const Vector& v);
MaybeNear of_rotated_cone(const Vector& x, const Vector& v);

/// {x >= 0, Σ x = total}: the support is that of x.
MaybeNear of_simplex(const Interval& total, const Vector& x, const Vector& v);
/// {Σ |x_i| <= radius}.
MaybeNear of_ball1(const Interval& radius, const Vector& x, const Vector& v);
/// {0 <= x <= cap, Σ x = total}.
MaybeNear of_capped_simplex(const Interval& total, const Interval& cap, const Vector& x, const Vector& v);
/// {a·x <= b}, or = b.
MaybeNear of_halfspace(const std::vector<Interval>& a, const Interval& b, bool two_sided, const Vector& x,
                       const Vector& v);
/// weight Σ |x_(i+1) - x_i|, and the cone of increasing x.
NearGraph of_total_variation(const Interval& weight, const Vector& x, const Vector& v);
NearGraph of_monotone_cone(const Vector& x, const Vector& v);
/// {|x_1 + … + x_i| <= bound, Σ x = 0}, the conjugate of the total variation.
MaybeNear of_bounded_partial_sums(const Interval& bound, const Vector& x, const Vector& v);

/// Functions of eigenvalues and of singular values (Lewis 1995, 1996), the matrix stacked by columns.
MaybeNear of_spectrum(const Call& f, const Vector& x, const Vector& v);

/// ½ x·Qx + c·x + constant, and {Ax = b}.
MaybeNear of_quadratic(const IntervalArguments&, const Vector& x);
MaybeNear of_affine(const IntervalArguments&, const Vector& x, const Vector& v);
/// s f(x/s) closed, {(x, t) : f(x) <= t}, and the proximal average, in the plain product.
MaybeNear of_perspective(const Call& inner, const Vector& x, const Vector& v);
MaybeNear of_epigraph(const Call& inner, const Vector& x, const Vector& v);
MaybeNear of_proximal_average(const IntervalArguments&, const Metric& W, const Vector& x, const Vector& v);
/// Operations: from pairs of their parts.
MaybeNear of_operation(const Call& f, const Metric& W, const Vector& x, const Vector& v);

/// centre and radius further by `by`; the middles of `by`.
void move_by(Vector& centre, Vector& radius, const std::vector<Interval>& by);
Vector middles(const std::vector<Interval>& by);

/// Σ x_i² in an interval, its root; Σ a_i b_i.
Interval square_sum(const Vector& x);
Interval sum(const Vector& x);
Interval product_sum(const Vector& a, const Vector& b);

}  // namespace convex::near_graphs
