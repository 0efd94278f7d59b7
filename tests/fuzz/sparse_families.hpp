#pragma once

#include "convex/nearest_point/problem.hpp"
#include "tests/fuzz/edge_families.hpp"

/// Sparse nearest-point problems at the edge of rounding that are made around their solution: small whole
/// numbers and powers of two, of which A q* - z = Σ lambda*_a u_a, lambda* >= 0, U q* >= s and
/// lambda*·(U q* - s) = 0 hold without rounding.
namespace fuzz {

struct PlantedSparse {
  convex::NearestPointProblem problem{convex::Metric::identity(0), {}, {}, {}, {}};
  convex::Vector q;       ///< the solution: n; empty where rows contradict each other
  convex::Vector slack;   ///< Uq* - s, whose signs are exact: m
  convex::Vector lambda;  ///< one choice of multipliers: m
};

inline constexpr int sparse_family_count = 8;
const char* sparse_family(int family);
PlantedSparse draw_sparse(int family, Random&);

}  // namespace fuzz
