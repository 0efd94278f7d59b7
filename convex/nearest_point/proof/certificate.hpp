#pragma once

#include <limits>

namespace convex::inline proof {

/// How an error bound was proved: not at all, in doubles with bounds on every rounding, or in fractions.
enum class ProofLevel { none, enclosure, exact };

/// error_bound >= ||q - q*||_A for the doubles q as they stand and the exact solution q*, when level is not
/// none.
struct Certificate {
  ProofLevel level = ProofLevel::none;
  double error_bound = std::numeric_limits<double>::infinity();
};

}  // namespace convex::inline proof
