#pragma once

#include <string>

#include "convex/nearest_point/solution.hpp"
#include "convex/vector.hpp"

namespace convex {

/// How a prox was computed. Two results of one route prove nothing about each other.
enum class ProxRoute { closed_form, active_set, iterative };

/// x = prox_f z = argmin ½||u - z||_W² + f(u) in a metric W.
struct Prox {
  Vector x;
  Vector v;  ///< a covector in the plain subdifferential of f at x, by its own formula where there is one;
             ///< equals W(z - x) at the exact solution
  double error_bound =
      0;  ///< ||x - x*||_W is at most this: ||W(x - z) + v||_(W⁻¹) and the rounding of x and v
  double duality_gap = 0;  ///< f(x) + f*(v) - x·v where the conjugate is at hand; quadratic in the error
  ProxRoute route = ProxRoute::closed_form;
  std::string
      method;  ///< the route in words: "closed form", "active set on the epigraph", "semismooth Newton", …
  Status status = Status::solved;
};

}  // namespace convex
