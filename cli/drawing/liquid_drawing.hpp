#pragma once

#include <optional>

#include "cli/drawing/gnuplot.hpp"
#include "mechanics/liquid/liquid_solution.hpp"

namespace cli::inline drawings {

/// The pressure with contours, the cavity hatched and outlined, below the title; walls that part in red; of
/// one coordinate p over it, of three the section through the middle of the domain, of the
/// first two or of `plane`, "x,z". With u as arrows, if
/// asked for; throws InvalidInput where there is one coordinate.
Drawing liquid_drawing(const mechanics::liquid::LiquidScene&, const mechanics::liquid::LiquidSolution&,
                       const std::string& title, bool with_velocity = false,
                       const std::optional<std::string>& plane = {});

}  // namespace cli::inline drawings
