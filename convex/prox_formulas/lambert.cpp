#include "convex/prox_formulas/lambert.hpp"

#include <cmath>

#include "convex/vector.hpp"

namespace convex::prox_formulas {

double lambert_w(double a) {
  if (a < 0x1p-30) return a - a * a;  // the next term of the series is below half a unit
  double w = std::log1p(a);
  for (double last = w;;) {
    const double next = w * (1 + std::log(a / w)) / (1 + w);
    const double step = std::abs(next - w);
    w = next;
    // Quadratic: from a step below 2⁻³⁰ of w the next is rounding. A step that does not shrink is.
    if (!(step > 0x1p-30 * w && step < last)) break;
    last = step;
  }
  return w * (1 + std::log(a / w)) / (1 + w);
}

}  // namespace convex::prox_formulas
