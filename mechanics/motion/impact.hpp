#pragma once

#include <vector>

#include "convex/metric.hpp"

namespace mechanics {

using convex::Index;
using convex::Vector;

/// A contact with f = 0 at an instant.
struct ImpactContact {
  Vector u;                ///< ∂f/∂q: n
  double rate = 0;         ///< df/dt before, f'(v-)
  double restitution = 0;  ///< e; counts as 0 where the contact opens before, f'(v-) > 0
  bool two_sided = false;
};

/// What an impact does. No v+ exists when the contacts exclude each other: then `excluding` has indices of
/// contacts, and the rest is empty.
struct ImpactOutcome {
  Vector change;   ///< v+ - v-: n
  Vector impulse;  ///< P, one a contact
  Vector rate;     ///< f'(v+), one a contact; exactly 0 where rounding hides the difference
  std::vector<Index> excluding;
};

/// Moreau's impact law: A (v+ - v-) = Σ P_a u_a, 0 <= P_a ⟂ f'_a(v+) + e_a f'_a(v-) >= 0, and P free,
/// f'(v+) = 0 for two-sided contacts. It is a nearest-point problem in the kinetic metric: v+ - v- is the
/// least change with u_a·(v+ - v-) >= -(1 + e_a) f'_a(v-), so that v+ is unique even where P is not. With one
/// e and all contacts closing, v+ = -e v- + (1 + e) proj_V v-, V = {v : f'_a(v) >= 0} (Moreau 1988).
ImpactOutcome impact(const convex::Metric& A, const std::vector<ImpactContact>& contacts);

}  // namespace mechanics
