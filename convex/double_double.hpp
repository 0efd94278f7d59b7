#pragma once

#include "convex/vector.hpp"

/// Sums of products in twice the working precision, after Ogita, Rump and Oishi, "Accurate sum and dot
/// product" (2005), algorithms TwoSum, TwoProduct and Dot2: the result is as if computed with unit roundoff
/// u² and then rounded, as long as nothing overflows or underflows.
namespace convex {

/// The unevaluated sum hi + lo, |lo| <= u |hi|.
struct DoubleDouble {
  double hi = 0, lo = 0;
  double value() const { return hi + lo; }
};

/// a + b exactly, as a pair (Knuth).
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b, b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// x + y for pairs; relative error at most 4u² when the terms do not cancel.
inline DoubleDouble add(DoubleDouble x, DoubleDouble y) {
  const DoubleDouble s = two_sum(x.hi, y.hi);
  return two_sum(s.hi, s.lo + (x.lo + y.lo));
}

/// The product of a and b exactly, as a pair.
DoubleDouble two_product(double a, double b);

/// A vector of pairs hi + lo, stored apart so that loops over it vectorise.
struct DoubleDoubleVector {
  Vector hi, lo;
  explicit DoubleDoubleVector(Index n = 0) : hi(Vector::Zero(n)), lo(Vector::Zero(n)) {}
  explicit DoubleDoubleVector(const Vector& x) : hi(x), lo(Vector::Zero(x.size())) {}
  Index size() const { return hi.size(); }
  Vector value() const { return hi + lo; }
  DoubleDouble operator[](Index i) const { return {hi[i], lo[i]}; }
  /// this += x, keeping |lo| <= u |hi|.
  void add(const Vector& x);
};

/// sum += c x, n entries of x at `x`; sum is a running pair per entry, made tidy by `add` or `value`.
void add_multiple(Index n, const double* x, DoubleDouble c, double* sum_hi, double* sum_lo);

/// x·(y_hi + y_lo) with x plain.
DoubleDouble dot(Index n, const double* x, const double* y_hi, const double* y_lo);

}  // namespace convex
