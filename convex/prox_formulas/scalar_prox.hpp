#pragma once

#include <cmath>
#include <limits>

#include "convex/vector.hpp"

namespace convex::prox_formulas {

/// The prox of a function of one variable, x = argmin f(u) + ½d (u - z)², d > 0, and its derivative
/// dx/dz = d / (d + f''(x)), in [0, 1]. z is finite, d is a normal number; a weight w on f is d/w.
struct ScalarProx {
  double x = 0, slope = 0;
};

/// The root of an increasing function on [lo, hi] by Newton's method, kept inside a bracket that at least
/// halves in every third step. f(x) returns {value, derivative}. Stops when Newton's step is rounding.
template <class Function>
double increasing_root(Function f, double lo, double hi, double x) {
  double width = std::numeric_limits<double>::infinity();
  for (int step = 0;; ++step) {
    const auto [value, slope] = f(x);
    double next = x - value / slope;
    if (std::abs(next - x) <= 2 * unit_roundoff * std::abs(x)) return next;
    (value < 0 ? lo : hi) = x;
    bool halve = !(next > lo && next < hi);
    if (step % 3 == 2) {
      halve = halve || hi - lo > width / 2;
      width = hi - lo;
    }
    if (halve) next = lo + (hi - lo) / 2;
    if (!(next > lo && next < hi)) return x;  // no double is left between them
    x = next;
  }
}

}  // namespace convex::prox_formulas
