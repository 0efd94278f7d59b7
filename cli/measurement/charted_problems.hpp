#pragma once

#include "cli/measurement/contest.hpp"
#include "cli/scene.hpp"

namespace cli::inline measurement {

/// A problem of the chart: it is made, and the methods put before it, when its turn comes.
struct ChartedProblem {
  std::string name;
  std::function<std::vector<Contest>()> contests;
};

/// What `moreau chart` charts without a file: small and large, redundant, ill-conditioned, chain, packing,
/// obstacle; and the prox of four functions in an ill-conditioned metric. `quick`: fewer and smaller.
/// `peers`, here and below: with the solvers of other packages.
std::vector<ChartedProblem> charted_problems(bool quick, bool peers);

/// What `moreau chart --profile` profiles without a file: every feasible family of the gallery at every
/// setting of its knob, small. `quick`: at its usual one.
std::vector<ChartedProblem> profiled_problems(bool quick, bool peers);

/// What `moreau chart --motion` charts: motions with closed forms, for longer and longer, and with more and
/// more contacts. `quick`: fewer.
std::vector<ChartedProblem> charted_motions(bool quick);

/// The problem of a file, with what --set says of it.
ChartedProblem charted_file(const std::string& file, const std::vector<std::string>& settings, bool peers);

}  // namespace cli::inline measurement
