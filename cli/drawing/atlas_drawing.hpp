#pragma once

#include "cli/drawing/gnuplot.hpp"
#include "cli/report/atlas_report.hpp"
#include "cli/scene.hpp"

namespace cli::inline drawings {

/// The map of an atlas over two forces: its regions by their contacts, hatched where dropping negative
/// multipliers is wrong; at the file's force, and in the other larger ones, the free acceleration A⁻¹z and
/// the true one as arrows, each of the two components to the scale of its largest, which the heading tells.
Drawing atlas_drawing(const SolvedAtlas&, const Scene&);

}  // namespace cli::inline drawings
