#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// f*(v) = sup_x v·x - f(x) by the proximal point method (Martinet 1970; Rockafellar 1976) on f - v·: with
/// x_0 = 0 and x_(k+1) the prox of f at x_k + v/t_k in t_k times the plain metric, the lower bounds
/// v·x_k - f(x_k) increase to f*(v) as sum 1/t_k does to infinity, whether the supremum is attained,
/// approached at infinity or +inf. It needs no program of f*, and so decides at the edge of its domain. t_k
/// falls to its power 3/2 at each step, as far as v/t_k does not drown x_k.
///
/// Of one entry it is found by the chords around it, where there are points on both sides with lower values:
/// see `line_supremum`. Elsewhere the value is a lower bound; the error is what the last step shows to be
/// left, t_k |x_(k+1) - x_k| |x_k|, with its increase, the rounding of f(x_k) and what the prox leaves open
/// of x_k; infinite where there is more beside it.
///
/// +inf is returned where it is proved: f∞(d) < v·d for a direction d, the axes, v, or where x_k and its last
/// step went (Rockafellar 1970, Theorem 8.5). Otherwise the error is infinite where the lower bounds do not
/// settle, grow as they may: a logarithm grows without end along no such direction.
///
/// Questions inside a supremum are answered by programs: a supremum never asks for another.
Value supremum(const Function& f, const Vector& v);

/// Where the supremum of a function of one entry is attained, a subgradient of f* at v; none where chords do
/// not find it.
std::optional<Vector> maximiser(const Function& f, const Vector& v);

/// Is f*(v) proved to be +inf, or do the lower bounds grow by more at each of eight steps in a row, and x_k
/// to 1e12 times its first length? No proof: a reason to refuse a function, not a value.
bool grows_without_end(const Function& f, const Vector& v);

/// Is a value right to roundings of itself, and one of 0 to far less than it is asked for?
bool is_of_rounding(const Value&);

/// The value of f* at v by a program that minimises, told closer where it may be: it is no more than `above`,
/// that of a point where its minimum is nearly attained, and no less than v·x - f(x).
Value between_points(const Value& by_program, const Value& above, const std::optional<Vector>& x,
                     const Function& f, const Vector& v);

/// `found`, the value of f* at v by a program, where it is settled; else the better of it and `supremum`. The
/// program minimises, so that its value is no less than f*(v); v·x - f(x) at its own maximiser x, where it
/// has one, is no more: what lies between is part of the error.
Value settled_value(const Value& found, const std::optional<Vector>& x, const Function& f, const Vector& v);

}  // namespace convex::inline operations
