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

/// The product of a and b exactly, as a pair: by a fused multiply-add where the machine compiled for has one,
/// else Dekker's with Veltkamp's split; the results are the same.
inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
#if defined(__FMA__) || defined(__aarch64__)
  return {product, __builtin_fma(a, b, -product)};
#else
  constexpr double splitter = 0x1p27 + 1;
  const double ca = splitter * a, a_high = ca - (ca - a), a_low = a - a_high;
  const double cb = splitter * b, b_high = cb - (cb - b), b_low = b - b_high;
  return {product, a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)};
#endif
}

/// x y for a pair and a number, exact to some u².
inline DoubleDouble product(DoubleDouble x, double y) {
  DoubleDouble p = two_product(x.hi, y);
  p.lo += x.lo * y;
  return two_sum(p.hi, p.lo);
}

/// x y for pairs, exact to some u².
inline DoubleDouble product_of_pairs(DoubleDouble x, DoubleDouble y) {
  DoubleDouble p = two_product(x.hi, y.hi);
  p.lo += x.lo * y.hi + x.hi * y.lo;
  return two_sum(p.hi, p.lo);
}

inline DoubleDouble negative(DoubleDouble x) { return {-x.hi, -x.lo}; }

/// x / y to some u².
inline DoubleDouble quotient(DoubleDouble x, DoubleDouble y) {
  const double first = x.hi / y.hi;
  const DoubleDouble back = product(y, first);
  return two_sum(first, add(x, negative(back)).value() / y.hi);
}

/// A running sum of many terms: hi is rounded, what is lost is gathered in lo (Ogita, Rump and Oishi's Sum2),
/// so that a term waits for one addition only.
struct RunningSum {
  double hi = 0, lo = 0;
  void add(double term) {
    const DoubleDouble sum = two_sum(hi, term);
    hi = sum.hi;
    lo += sum.lo;
  }
  void add(DoubleDouble term) {
    add(term.hi);
    lo += term.lo;
  }
  double value() const { return hi + lo; }
  DoubleDouble tidy() const { return two_sum(hi, lo); }
};

/// sum += x c for a running pair.
inline void accumulate_product(double x, DoubleDouble c, double& sum_hi, double& sum_lo) {
  const DoubleDouble term = two_product(x, c.hi), sum = two_sum(sum_hi, term.hi);
  sum_lo += sum.lo + (term.lo + x * c.lo);
  sum_hi = sum.hi;
}

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
