#pragma once

#include <optional>
#include <string>

#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/labelled_page.hpp"
#include "cli/report/solve_report.hpp"

namespace cli::inline drawings {

/// The decomposition of Moreau 1966, drawn in a plane of two accelerations (`plane_section`): the free
/// acceleration A⁻¹z, A⁻¹C = {U q'' >= s} with the names of the contacts on their lines, the acceleration q''
/// = A⁻¹proj_C z, the reaction A⁻¹R from the one to the other, the polar cone at q'' (of the A⁻¹(-u_a) of the
/// contacts that persist), the acceleration of the classical hypothesis, and the circles of the kinetic
/// metric about A⁻¹z: ellipses, of which the outer touches A⁻¹C at q''. Nothing is labelled that is not
/// drawn. Throws InvalidInput as `plane_section` does.
Drawing decomposition_drawing(const SolvedScene&, const std::optional<std::string>& plane,
                              PageArea area = {});

}  // namespace cli::inline drawings
