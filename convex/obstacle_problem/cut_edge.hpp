#pragma once

#include "convex/obstacle_problem/cut_equations.hpp"

namespace convex::inline obstacle_problem {

/// Projected red-black sweeps: each point in turn to its own minimum, not below its bound, which is met
/// exactly, by 0.
void relax_all(const CutEquations&, int sweeps, std::vector<double>& q);
/// The same on the points around the edge of a set of held ones, within half as many steps as sweeps; those
/// at their bound are held then, the others not. They move the edge to about where the values around want it,
/// for much less than a solve of the equations costs.
void relax_edge(const CutEquations&, int sweeps, std::vector<std::uint8_t>& held, std::vector<double>& q);

}  // namespace convex::inline obstacle_problem
