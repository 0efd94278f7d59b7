#include "convex/functions/interior.hpp"

#include <cmath>

#include "convex/gamma0/facts.hpp"
#include "convex/gamma0/node.hpp"

namespace convex::inline named_functions {

bool is_well_inside(const Function& f, const Vector& x, double size) {
  constexpr double far_more = 1e3 * membership_tolerance;
  constexpr Index most_entries = 64;
  if (x.size() > most_entries) return false;
  const double step = far_more * std::sqrt(static_cast<double>(x.size())) * size;
  if (!std::isfinite(x.norm() + step)) return false;
  for (Index i = 0; i < x.size(); ++i)
    for (const double side : {-step, step}) {
      const Value beside = f.evaluate(x + side * Vector::Unit(x.size(), i));
      if (!std::isfinite(beside.value) || !std::isfinite(beside.error)) return false;
    }
  return true;
}

bool is_beyond_domain(const Function& f, const Vector& x, double size) {
  const double tolerance = membership_tolerance * (size + x.norm());
  for (Index i = 0; i < x.size(); ++i)
    for (const Vector& e : {Vector(Vector::Unit(x.size(), i)), Vector(-Vector::Unit(x.size(), i))})
      if (e.dot(x) - f.node().domain_support(e) > tolerance) return true;
  return false;
}

}  // namespace convex::inline named_functions
