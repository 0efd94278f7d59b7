#pragma once

#include <optional>

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// A point of a domain but for what it may miss of it.
struct Member {
  Vector at;
  double miss = 0;
};

/// The nearest point of the domain of f to x, which comes with the rounding of numbers as large as `size`; of
/// an interval its end, if f has a value there. What it may miss: some roundings of the end, or of what a
/// formula finds, and what a program may where none does.
Member nearest_member(const Function& f, const Vector& x, double size);

/// How far x may be from the domain, though a value counts it in.
double miss_of(const Function& f, const Vector& x, double size);

/// By how much a value at points that miss their domains may be too low, as that of a sum over a split of x:
/// to first order what they miss times the slope at x; where a part bends sharply there, as the root of u at
/// 0, more. Nothing where no slope is known, as at an x that is in the domain but for rounding.
double cost_of_miss(double miss, const std::optional<Vector>& slope);

}  // namespace convex::inline operations
