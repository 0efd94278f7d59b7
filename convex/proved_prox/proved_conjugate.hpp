#pragma once

#include "convex/proved_prox/proved_split.hpp"

namespace convex::inline proved_prox {

/// What is proved of a value: it lies in the interval, which may be [inf, inf]; `exact` where it is a
/// fraction.
struct ProvedValue {
  ProofLevel level = ProofLevel::none;
  ProvedInterval interval = {-INFINITY, INFINITY};
  std::optional<Fraction> exact;
  std::string why_none;

  /// The largest distance of a double from the interval's numbers; 0 of inf where the value is inf.
  double error_of(double value) const;
};

/// g(y) = sup_x (x|y) - f(x) = f*(Wy), question.z being y: in fractions where f is piecewise
/// linear-quadratic. Else between x·Wy - f(x) for a pair near Wy and f* there in balls, which enclose it
/// where a pair with the covector Wy itself is found.
ProvedValue proved_conjugate(const SplitQuestion& question);

/// The part of the most word operations that a value in fractions may take by the way: some hundredths of a
/// second.
constexpr double quick_part_of_operations = 0.01;

/// f(x) for a function made in the product of W, where it is an infimum over more variables: its doubles
/// taken for fractions where it is piecewise linear-quadratic and they take no longer than doubles may, else
/// held between what supremum_between.hpp proves of f = f**. A formula's value stays as it is.
Value decided_value(const Function& f, const Metric& W, const Vector& x);

/// g(y) as it is told: in fractions where f is piecewise linear-quadratic and they take no longer than
/// doubles may. Slopes and rows that agree but for roundings may have the supremum anywhere along what
/// doubles take for nothing, as that of 4x - max(4x, 3.9999999999999964x + 1) at 1e15. The numbers are those
/// written; what their roundings, of which the functions are made, would make of the value is its error. A y
/// that a rounding puts outside the domain keeps the value beside it. Beside curved terms fractions bound the
/// value (see supremum_between.hpp); where that of doubles is outside, the bounds are told.
Value decided_conjugate(const SplitQuestion& written, const Function& g, const Vector& y);

}  // namespace convex::inline proved_prox
