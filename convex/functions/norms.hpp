#pragma once

#include "convex/functions/function.hpp"

/// Norms and other support functions of plain coordinates. weight >= 0; 0 gives the function 0.
namespace convex {

/// weight |x|₂, the support function of ball2(weight).
Function norm2(double weight = 1);

}  // namespace convex
