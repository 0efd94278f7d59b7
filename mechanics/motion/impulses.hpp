#pragma once

#include "mechanics/motion/impact.hpp"

namespace mechanics::inline motions {

/// All P of an impact: v+ is unique, P is where no others give the same Σ P_a u_a on the contacts that may
/// push, with P_a >= 0 on the one-sided ones.
struct Impulses {
  bool unique = true;
  Vector least_norm;  ///< one a contact, of least Euclidean norm; empty where no v+ exists
};

/// Of Moreau's law: contacts with f'_a(v+) + e_a f'_a(v-) = 0 may push.
Impulses moreau_impulses(const convex::Metric& A, const std::vector<ImpactContact>& contacts);

/// Of an outcome of another law: contacts that close before the impact, or have pushed in it, may push.
Impulses impulses_of(const convex::Metric& A, const std::vector<ImpactContact>& contacts,
                     const ImpactOutcome& outcome);

}  // namespace mechanics::inline motions
