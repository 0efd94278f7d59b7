#pragma once

#include "convex/linear_quadratic/linear_quadratic.hpp"
#include "convex/linear_quadratic/minimise.hpp"

namespace convex::linear_quadratic {

/// Whether f is proper: somewhere finite, and then, being piecewise linear-quadratic, nowhere -inf.
Defect properness(const LinearQuadratic& f);

/// Throws InvalidInput "where: …" when f is not proper.
void require_proper(const LinearQuadratic& f, const char* where);

}  // namespace convex::linear_quadratic
