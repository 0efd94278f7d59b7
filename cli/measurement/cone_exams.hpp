#pragma once

#include "cli/measurement/contest.hpp"

/// Projections on the polar of a cone, where the part that lies in the polar is small or the cone is nearly
/// flat. The error is |y - y*| over |y*|, y the part in the polar: what z - proj_K z loses.
namespace cli::inline measurement {

enum class CurvedCone { exponential, power };

/// A point whose distance from the cone's boundary is about `distance`, its projection on the cone being of
/// size 1. The truth is found with 50 digits. Ways: `auto` (the conjugate's own formula), `difference`
/// (z - proj_K z), `iterative` (z minus the iterative prox).
std::vector<Contest> boundary_contests(CurvedCone, double distance);

/// The polar of the cone that eight vectors of slope `slope` around an axis generate, nearly a plane when the
/// slope is small. Planted exactly on an edge. Ways: `auto`, `difference`, `iterative`, and `facets`: the
/// polar's own generators, found in fractions, rounded and projected upon.
std::vector<Contest> flat_polar_contests(double slope);

}  // namespace cli::inline measurement
