#pragma once

#include <span>
#include <vector>

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// prox of max(f, g) by its dual in one number: the maximum over 0 <= t <= 1 of min over u of
/// ½||u - z||_W² + (1 - t) f(u) + t g(u) (Rockafellar 1970, Theorem 36.3), u(t) the prox of the weighted sum.
/// g - f falls along u(t), and is 0 at the solution, or t is at an end: a root in t by bisection and secants.
/// It needs values and proxes of sums alone, no heights, and so serves where f and g are much larger than
/// their arguments.
///
/// A function that is not finite everywhere keeps a weight of 1e-30 at the least, and with it its domain.
///
/// The error bound follows from where the weight may be (`WeightRange`), which proxes on both sides of the
/// root tell. g - f moves with what these proxes miss, too, by what the same prox found another way tells: an
/// estimate.
std::optional<Prox> prox_of_two_function_max(const Function& f, const Function& g, const Vector& z,
                                             const Metric& W, const Look& look = {});

/// The conjugate of max(f, g) at v, the least over 0 <= t <= 1 of that of (1 - t) f + t g (Rockafellar 1970,
/// Theorem 16.5): each is an upper bound, and v·x - max(f, g)(x) a lower one, for which g - f is to be 0
/// where the supremum of the mean is attained, a root in t as above. The error is what lies between the best
/// of both. None where a mean's conjugate tells no point.
std::optional<Value> conjugate_of_two_function_max(const Function& f, const Function& g, const Vector& v);

/// Where one of the functions, no maximum itself, is above all others at its own prox, that is the prox of
/// their maximum: the weights end at a corner. Nothing where this is so of none.
std::optional<Prox> prox_of_part_above(std::span<const Function> parts, const Vector& z, const Metric& W,
                                       const Look& look);

/// The functions of which f is the maximum; none when it is not made as one, or is a program.
std::vector<Function> parts_of_max(const Function& f);

/// The maximum where it is known that some point has all parts finite, two or more.
Function proper_max(std::vector<Function> parts);

/// `prox_of_two_function_max` for two functions or more, as the first and the maximum of the rest. A maximum
/// in a maximum is taken so once; none further inside.
std::optional<Prox> prox_of_max(std::span<const Function> parts, const Vector& z, const Metric& W,
                                const Look& look);
/// And the conjugate's value.
std::optional<Value> conjugate_of_max(std::span<const Function> parts, const Vector& v);

}  // namespace convex::inline operations
