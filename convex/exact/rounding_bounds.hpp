#pragma once

#include <cmath>

#include "convex/vector.hpp"

/// Upper bounds on what rounding to nearest may have done (Higham 2002, chapter 3; Ogita, Rump and Oishi
/// 2005). They hold for sums in any order, with or without fused operations, as long as nothing underflows or
/// overflows; whoever uses them sees to that. The rounding mode is never touched.
namespace convex::inline exact_arithmetic {

/// Nonzero numbers outside of this range might underflow in products of a few of them.
inline constexpr double largest_ordinary = 0x1p150, smallest_ordinary = 0x1p-150;

template <class Numbers>
bool is_ordinary(const Numbers& numbers) {
  for (Index i = 0; i < numbers.size(); ++i) {
    const double x = std::abs(numbers.data()[i]);
    if (x != 0 && !(x >= smallest_ordinary && x <= largest_ordinary)) return false;
  }
  return true;
}

/// Entries too small to be ordinary become 0: proofs hold for any preconditioner.
inline void keep_ordinary(Matrix& M) { M = (M.array().abs() >= smallest_ordinary).select(M, 0.0); }

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

}  // namespace convex::inline exact_arithmetic
