#pragma once

#include "convex/exact_program/exact_minimum.hpp"
#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// How the minimum of ½|x|² + f(x) over n entries ends, in fractions: f is piecewise linear-quadratic. So it
/// is decided whether a point has it finite, and whether it is above -inf. None for other functions, and
/// where that takes too many word operations.
std::optional<ProgramEnd> exact_end(const Function& f, Index n);

/// f(x) in fractions, rounded once, under the same conditions and where it is finite.
std::optional<Value> exact_value_at(const Function& f, const Vector& x);

}  // namespace convex::inline operations
