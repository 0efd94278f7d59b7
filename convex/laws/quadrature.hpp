#pragma once

#include <functional>

namespace convex::inline law_checks {

/// An integral, and the sum over its intervals of what Kronrod's rule of 21 points differs from Gauss' of 10.
struct Quadrature {
  double value = 0, error = 0;
};

/// The integral of f from a to b, a <= b or not. The interval of the largest difference is halved until all
/// of them together are at most `tolerance`, at most `most_intervals` times (Piessens et al. 1983: QUADPACK).
Quadrature integral(const std::function<double(double)>& f, double a, double b, double tolerance);

inline constexpr int most_intervals = 60;

}  // namespace convex::inline law_checks
