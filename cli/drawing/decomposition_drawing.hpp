#pragma once

#include <string>

#include "cli/drawing/gnuplot.hpp"
#include "cli/report/solve_report.hpp"

namespace cli {

/// The decomposition of Moreau 1966, drawn in the plane of the accelerations of a scene with two coordinates:
/// the free acceleration A⁻¹z, C = {U q'' >= s}, the acceleration q'' = A⁻¹proj_C z, the reaction A⁻¹R from
/// the one to the other, the polar cone at q'' (of the A⁻¹(-u_a) of the contacts that persist), the
/// acceleration of the classical hypothesis, and the circles of the kinetic metric about A⁻¹z: ellipses, of
/// which the outer touches C at q''. Throws InvalidInput when the scene has not two coordinates or no answer.
Drawing decomposition_drawing(const SolvedScene&);

}  // namespace cli
