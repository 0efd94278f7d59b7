#pragma once

#include "convex/double_double.hpp"
#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// So much over the scale squared weighs more than any function: a prox in that metric is the nearest point
/// of the domain.
inline constexpr double stiffest_weight = 1e30;

/// |x|, also where its square is no ordinary double: of a miss of 1e-170 it is not 0.
double length_of(const Vector& x);

/// A value beside y, and how far from y.
struct NearValue {
  Value value;
  double moved = 0;
};

/// f(y) for a y that comes with the rounding of numbers as large as `size`: where f is +inf but finite within
/// `membership_tolerance` of that, the value there.
NearValue near_value(const Function& f, const Vector& y, double size);
Value value_near(const Function& f, const Vector& y, double size);

/// The same of a y of twice the precision. Where f cancels, as x log x at 1, its value at the rounded y is
/// not f(y) to roundings of itself: to first order y.lo adds v·y.lo, v a subgradient at y.hi; what the slopes
/// leave open of that is counted. Values that a program finds are less accurate than that and stay.
NearValue near_value(const Function& f, const DoubleDoubleVector& y, double size);
Value value_near(const Function& f, const DoubleDoubleVector& y, double size);

/// x / s, s not 0, to twice the precision.
DoubleDoubleVector quotient(const Vector& x, double s);

DoubleDoubleVector quotient(const DoubleDoubleVector& x, DoubleDouble s);

/// x - b exactly.
DoubleDoubleVector difference(const Vector& x, const Vector& b);
/// x - b to twice the precision.
DoubleDoubleVector difference(const DoubleDoubleVector& x, const Vector& b);

}  // namespace convex::inline operations
