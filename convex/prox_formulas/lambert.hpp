#pragma once

namespace convex::prox_formulas {

/// W(a), the root w >= 0 of w e^w = a, for 0 <= a < inf (principal branch). By Newton's method on
/// w + log w = log a, in the form of Iacono and Boyd (2017, equation 11), which converges from log(1 + a).
double lambert_w(double a);

}  // namespace convex::prox_formulas
