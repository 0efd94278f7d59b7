#pragma once

#include <array>

#include "mechanics/expression/operation.hpp"
#include "mechanics/expression/rounded.hpp"

namespace mechanics::expression {

/// How many time derivatives are followed.
inline constexpr int most_derivatives = 12;

/// A function of time near an instant by its Taylor coefficients, f(t + τ) = Σ c_k τ^k, each with a bound on
/// what rounding did to it; not finite, in value or radius, where the derivative does not exist.
struct TimeSeries {
  std::array<Rounded, most_derivatives + 1> c;

  TimeSeries() = default;
  explicit TimeSeries(Rounded constant) { c[0] = constant; }
  /// d^k f/dt^k = k! c_k.
  Rounded derivative(int k) const;
};

/// Where branches are told apart: min, max, abs, sign and if. At the instant, as all that is evaluated does;
/// or just after it, by the first coefficient that is not exactly 0, for derivatives from the right.
enum class Instant { now, after };

/// The operation on functions of time, coefficients 0 to `order` (Griewank and Walther 2008, section 13.2:
/// each function solves a linear differential equation in its operand). A unary operation ignores b;
/// `constant_b`: b does not vary, whatever its operand.
TimeSeries applied(Operation operation, const TimeSeries& a, const TimeSeries& b, bool constant_b, int order,
                   Instant instant = Instant::now);

}  // namespace mechanics::expression
