#pragma once

#include <optional>
#include <string>

#include "cli/drawing/drawn_scene.hpp"
#include "cli/drawing/gnuplot.hpp"
#include "cli/drawing/labelled_page.hpp"
#include "cli/report/solve_report.hpp"

namespace cli::inline drawings {

/// The mechanism of `[draw]` at its state, with the forces of its contacts as arrows to one scale, each named
/// with its size.
Drawing mechanism_drawing(const SolvedScene&, const DrawnScene&, PageArea area);

/// What `solve --plot` shows: the mechanism where `[draw]` has one, and beside it the decomposition where
/// there are two coordinates or more; without `[draw]` the decomposition.
Drawing scene_drawing(const SolvedScene&, const DrawnScene&, const std::optional<std::string>& plane);

}  // namespace cli::inline drawings
