#pragma once

#include "convex/double_double.hpp"
#include "convex/vector.hpp"

namespace convex::prox_formulas {

/// Changes entries of y, where it has to, so that its running sums are those allowed: allowed(i, sum) is the
/// nearest to `sum` that y_0 + … + y_i may be.
template <class Allowed>
void keep_running_sums(Vector& y, const Allowed& allowed) {
  DoubleDouble sum;
  for (Index i = 0; i < y.size(); ++i) {
    sum = add(sum, {y[i], 0});
    const double change = allowed(i, sum.value()) - sum.value();
    y[i] += change;
    sum = add(sum, {change, 0});
  }
}

}  // namespace convex::prox_formulas
