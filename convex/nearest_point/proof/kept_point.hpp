#pragma once

#include <optional>
#include <vector>

#include "convex/nearest_point/proof/held_point.hpp"
#include "convex/nearest_point/solution.hpp"

namespace convex::inline proof {

/// The rows with a multiplier.
std::vector<Index> loaded_rows(const Solution&);

/// z + Uᵀlambda - Aq and s - Uq of the solution as it stands, lambda over `rows` alone.
KktResidual residual_as_it_stands(const NearestPointProblem&, const RadiiOf&, const Solution&,
                                  const std::vector<Index>& rows);

/// That residual where the doubles q satisfy all rows without rounding, those with a multiplier with
/// equality, and no one-sided multiplier is negative: then ||q - q*||_A <= ||Aq - z - Uᵀlambda||_(A⁻¹),
/// however the rows depend on each other. None elsewhere, or where there are radii.
std::optional<KktResidual> residual_of_kept_point(const NearestPointProblem&, const RadiiOf&,
                                                  const Solution&);

}  // namespace convex::inline proof
