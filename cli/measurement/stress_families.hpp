#pragma once

#include "cli/measurement/contest.hpp"

namespace cli::inline measurement {

/// Problems of one kind, harder and harder along one knob, each put before several methods.
struct StressFamily {
  std::string name, knob;
  std::vector<double> ladder;  ///< settings of the knob, easiest first
  std::function<std::vector<Contest>(double setting)> at;
};

/// The families of the gallery at `size` (or less), the gallery's well-posed one by its size, and those of
/// the convex layer: prox by the condition of the metric, ties, the boundaries of curved cones, polars of
/// nearly flat cones; motions. `peers`: with the solvers of other packages, where they were found.
std::vector<StressFamily> stress_families(convex::Index size, bool peers);

}  // namespace cli::inline measurement
