#pragma once

#include <memory>
#include <string>

#include "convex/exact/ball_module/ball_operations.hpp"
#include "convex/exact/fraction.hpp"

namespace convex::inline exact_arithmetic {

/// A real number known to lie within a radius of a midpoint (Johansson 2017: Arb): whatever is computed from
/// balls contains what would be computed from the numbers. Held by a module that is loaded at first use.
class Ball {
 public:
  /// Why there are no balls; empty when there are. Where it is not, nothing below may be called.
  static const std::string& why_none();

  /// The fraction, rounded to `precision` bits; exact where it fits.
  static Ball of(const Fraction& value, long precision);
  static Ball pi(long precision);
  /// A function of one number (of two); the working precision is that of the operands.
  static Ball apply(BallFunction function, const Ball& a);
  static Ball apply(BallFunction function, const Ball& a, const Ball& b);

  long precision() const { return precision_; }
  /// 1 or -1 when that is the sign of every number in the ball, else 0.
  int sign() const;
  /// Not so where the function is not defined, or the ball too wide to tell.
  bool is_finite() const;
  /// A dyadic fraction. Of a finite ball whose exponent fits a word.
  Fraction midpoint() const;
  /// At least the radius; may be infinite.
  double radius() const;

 private:
  explicit Ball(long precision);
  std::shared_ptr<void> handle_;
  long precision_;
};

}  // namespace convex::inline exact_arithmetic
