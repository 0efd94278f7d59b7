#pragma once

#include <optional>
#include <string>

#include "convex/gamma0/value.hpp"
#include "convex/status.hpp"
#include "convex/vector.hpp"

namespace convex::inline gamma0 {

/// What computed a prox.
enum class ProxRoute { closed_form, active_set, iterative };

/// f(x) and f*(v) for the x and v of a prox, made of the values of the functions that f is made of and of
/// their conjugates there: feasible for the two programs of which one is minus the other, so that each is at
/// least what it stands for, and together they are x·v where x and v are right (Fenchel 1949).
struct PairOfValues {
  Value f_x, f_v;
  /// How far from x the parts were valued, as a part of the sizes that their arguments are made of.
  double miss = 0;
};

/// The same of the conjugate, v its point and x its covector.
inline PairOfValues turned_round(const PairOfValues& values) { return {values.f_v, values.f_x, values.miss}; }

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
  std::optional<PairOfValues> values = std::nullopt;  ///< where the way to x and v gives them
};

/// Were the proxes of a function and of its conjugate at one point found without each other? Only then is it
/// evidence that they add up to the point.
inline bool are_two_routes(const Prox& x, const Prox& y) { return !x.by_conjugate && !y.by_conjugate; }

}  // namespace convex::inline gamma0
