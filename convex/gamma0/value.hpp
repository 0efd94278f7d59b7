#pragma once

namespace convex::inline gamma0 {

/// f(x) as it was computed. The true value is within `error`: a few roundings of the terms where a formula
/// gives it, what a program leaves open otherwise, +inf where it was not decided whether x is in the domain.
struct Value {
  double value = 0;
  double error = 0;
};

/// A sum whose terms, of these sizes together, are rounded: it is right to some roundings of them, and where
/// they cancel that is more than some of its own.
Value sum_of_terms(double sum, double sizes);

/// The indicator of a set that a point misses by `miss`, where the numbers compared are of `size`: a point
/// of a prox is inside, and whether one that only `membership_tolerance` lets in is, is not decided.
Value indicated(double miss, double size);

/// a + b, none of them -inf, and factor · a, factor > 0, each rounded.
Value sum_of(const Value& a, const Value& b);
Value multiple_of(double factor, const Value& a);

}  // namespace convex::inline gamma0
