#include "convex/prox_formulas/log_barrier.hpp"

namespace convex::prox_formulas {

ScalarProx prox_log_barrier(double z, double d) {
  const double h = 2 / std::sqrt(d), root = std::hypot(z, h);
  // The sum of the roots is z, their product -h²/4: no difference of near numbers is taken.
  const double x = z > 0 ? z / 2 + root / 2 : h / 2 * (h / (root - z));
  return {x, x / root};
}

ScalarProx prox_log_barrier_conjugate(double z, double d) {
  const double h = 2 / std::sqrt(d), root = std::hypot(z, h);
  const double x = z < 0 ? z / 2 - root / 2 : -(h / 2) * (h / (root + z));
  return {x, -x / root};
}

}  // namespace convex::prox_formulas
