#pragma once

#include "mechanics/motion/impact.hpp"

namespace mechanics::inline motions {

/// All P of Moreau's law at an impact: v+ is unique, P is where no others give the same Σ P_a u_a on the
/// contacts that may push.
struct MoreauImpulses {
  bool unique = true;
  Vector least_norm;  ///< one a contact, of least Euclidean norm; empty where no v+ exists
};

MoreauImpulses moreau_impulses(const convex::Metric& A, const std::vector<ImpactContact>& contacts);

}  // namespace mechanics::inline motions
