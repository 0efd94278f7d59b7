#pragma once

#include <cmath>

#include "convex/vector.hpp"

/// Upper bounds on what rounding to nearest may have done (Higham 2002, chapter 3; Ogita, Rump and Oishi
/// 2005). They hold for sums in any order, with or without fused operations, as long as nothing underflows or
/// overflows; whoever uses them sees to that. The rounding mode is never touched.
namespace convex {

/// A bound itself is a sum of at most some thousands of positive terms, each rounded: this much more covers
/// it.
inline double above(double bound) { return bound * (1 + 0x1p-30); }
inline double below(double bound) { return bound * (1 - 0x1p-30); }

/// gamma_n = n u / (1 - n u): of a sum of n products.
inline double gamma(Index n) { return above(static_cast<double>(n + 2) * unit_roundoff); }

/// At least |x|₂, without underflow in squares.
template <class Column>
double norm_above(const Column& x) {
  if (x.size() == 0) return 0;
  const double largest = x.cwiseAbs().maxCoeff();
  return largest > 0 ? above(largest * (x / largest).norm()) : 0;
}

/// An interval about a computed number.
struct Enclosed {
  double value = 0, radius = 0;
};

/// Σ x_i y_i in twice the working precision (Dot2), term by term, with a bound on its error.
class CompensatedSum {
 public:
  void add(double x, double y);
  Enclosed result() const;

 private:
  double sum_ = 0, rest_ = 0, magnitude_ = 0;
  Index terms_ = 0;
};

/// The same for a vector of sums: entry i of every term is x_i y.
class CompensatedSums {
 public:
  explicit CompensatedSums(Index n);
  void add(const double* x, double y);
  void result(Vector& value, Vector& radius) const;

 private:
  Vector sum_, rest_, magnitude_;
  Index terms_ = 0;
};

}  // namespace convex
