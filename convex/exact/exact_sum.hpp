#pragma once

#include "convex/exact/fraction.hpp"

namespace convex::inline exact_arithmetic {

/// A sum of doubles and of products of two doubles, without rounding: as three doubles while these can hold
/// it (what two_sum and two_product leave over is carried on, after Shewchuk 1997), else as a fraction.
class ExactSum {
 public:
  void add(double term);
  void add_product(double x, double y);
  int sign() const;
  /// The nearest double.
  double value() const;

 private:
  void spill();
  bool take(double term);

  double high_ = 0, middle_ = 0, low_ = 0;
  bool is_fraction_ = false;
  Fraction sum_;  ///< when it is one
};

}  // namespace convex::inline exact_arithmetic
