#pragma once

#include <optional>

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::linear_quadratic {

/// f(x) with its witnesses.
struct Evaluation {
  double value = 0;  ///< +inf outside the domain, -inf where f is unbounded below in w
  double error = 0;  ///< of a finite value: the duality gap of the program; +inf where x may be outside
  Vector xi;         ///< (x, w), w optimal: n + k
  std::optional<Vector> v;  ///< a subgradient of f at x, from the multipliers; none where f(x) is infinite
  Status status = Status::solved;  ///< solved or inaccurate
};

/// f(x): the linear or quadratic program in w. When rounding keeps x out of the domain by at most
/// `membership_tolerance` of its size and of the bounds that it meets, the value is the one at the nearest
/// point of the domain. x: n.
Evaluation evaluate(const LinearQuadratic& f, const Vector& x);

/// f(x) alone; not a number when it could not be found accurately.
double value(const LinearQuadratic& f, const Vector& x);

/// sup_x v·x - f(x) found directly, as a program in all variables; +inf when v is outside the domain of f* by
/// more than rounding. Not a number when f is empty or the program could not be solved accurately. v: n.
double supremum(const LinearQuadratic& f, const Vector& v);

/// The distance between x and prox_f(x + v) in the plain metric: 0 exactly when v is a subgradient of f at x.
double subgradient_defect(const LinearQuadratic& f, const Vector& v, const Vector& x);

}  // namespace convex::linear_quadratic
