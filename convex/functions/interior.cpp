#include "convex/functions/interior.hpp"

#include <cmath>

#include "convex/gamma0/facts.hpp"

namespace convex::inline named_functions {

bool is_well_inside(const Function& f, const Vector& x, double size) {
  constexpr double far_more = 1e3 * membership_tolerance;
  constexpr Index most_entries = 64;
  if (x.size() > most_entries) return false;
  const double step = far_more * std::sqrt(static_cast<double>(x.size())) * size;
  if (!std::isfinite(x.norm() + step)) return false;
  for (Index i = 0; i < x.size(); ++i)
    for (const double side : {-step, step})
      if (!std::isfinite(f(x + side * Vector::Unit(x.size(), i)))) return false;
  return true;
}

}  // namespace convex::inline named_functions
