#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline named_functions {

/// log Σ e^(x_i). Conjugate: Σ v log v on the simplex Σ v = 1, v >= 0 (Rockafellar 1970, section 16).
Function log_sum_exp();

}  // namespace convex::inline named_functions
