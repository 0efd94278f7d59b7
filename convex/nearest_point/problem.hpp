#pragma once

#include <vector>

#include "convex/constraint_rows.hpp"
#include "convex/metric.hpp"

namespace convex {

/// The nearest-point problem (Moreau 1966, (10), (13)): find q (written q'' in mechanics) that minimises
/// ½ q·Aq - z·q over u_a·q >= s_a, with equality for the two-sided rows. With x = Aq and (x|y) = x·A⁻¹y
/// it reads x = proj_C z, C = {x : (u_a|x) >= s_a}.
/// A: n×n; z: n; U: m×n, row a is u_a; s: m; two_sided: increasing indices of rows.
struct NearestPointProblem {
  Metric A;
  Vector z;
  ConstraintRows U;
  Vector s;
  std::vector<Index> two_sided;

  Index dimension() const { return A.dimension(); }
  Index rows() const { return U.count(); }
};

/// Throws InvalidInput when sizes do not fit, an entry is not finite, or `two_sided` names no row.
void validate(const NearestPointProblem&);

}  // namespace convex
