#pragma once

#include "convex/nearest_point/active_set/refinement.hpp"

namespace convex::inline dual_active_set {

/// u_a·q - s_a of all rows at a refined point: 0 on the working set; those near zero in twice the working
/// precision, and 0 when they cannot be told from it. A violation so taken for 0 may move the edge of rows at
/// a small angle: that is added to `dropped` of the point. row_scale: ||u_a||_(D⁻¹), D the diagonal of A.
Vector refined_slacks(WorkingSet& set, RefinedPoint& point, const Vector& row_scale);

}  // namespace convex::inline dual_active_set
