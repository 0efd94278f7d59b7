#pragma once

#include <string>
#include <vector>

#include "mechanics/liquid/sample.hpp"

namespace cli::inline reports {

/// The points of the domain as a table: the coordinates, p, growth, cavity (0 or 1).
void write_liquid_table(const std::string& file, const std::vector<std::string>& coordinates,
                        const mechanics::liquid::LiquidSample&);

/// The same as a VTK image, with an array `inside` that is 1 in the domain.
void write_liquid_image(const std::string& file, const mechanics::liquid::LiquidSample&);

}  // namespace cli::inline reports
