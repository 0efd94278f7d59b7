#pragma once

#include <string>

#include "convex/nearest_point/solution.hpp"
#include "convex/vector.hpp"

namespace convex {

/// What computed a prox.
enum class ProxRoute { closed_form, active_set, iterative };

/// x = prox_f z = argmin ½||u - z||_W² + f(u) in a metric W.
struct Prox {
  Vector x;
  Vector v;  ///< a covector in the plain subdifferential of f at x, by its own formula where there is one;
             ///< equals W(z - x) at the exact solution
  double error_bound = 0;  ///< ||x - x*||_W is at most this: ||W(x - z) + v||_(W⁻¹), what v misses of the
                           ///< subdifferential at x, and the rounding of x and v
  double duality_gap = 0;  ///< f(x) + f*(v) - x·v where the conjugate is at hand; quadratic in the error
  ProxRoute route = ProxRoute::closed_form;
  std::string
      method;  ///< the route in words: "closed form", "active set on the epigraph", "semismooth Newton", …
  Status status = Status::solved;
  /// The whole or a part of it was found from the prox of the conjugate (Moreau's identity, or the partition
  /// that the conjugate's prox found): beside that conjugate's prox it proves nothing.
  bool by_conjugate = false;
};

/// Were the proxes of a function and of its conjugate at one point found without each other? Only then is it
/// evidence that they add up to the point.
inline bool are_two_routes(const Prox& x, const Prox& y) { return !x.by_conjugate && !y.by_conjugate; }

}  // namespace convex
