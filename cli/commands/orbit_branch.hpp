#pragma once

#include <string>

#include "cli/problem_file/problem.hpp"
#include "cli/report/answer.hpp"
#include "mechanics/motion/orbit.hpp"

namespace cli::inline commands {

/// What `moreau orbit` is told.
struct OrbitOptions : FileOptions, MotionChoice {
  std::optional<std::string> period;  ///< an expression in the parameters, or "free"
  long periods = 1;
  std::optional<std::string> over;  ///< "w=1:0.01:3"
  std::vector<std::string> modulo;  ///< "a=2*pi"
  std::optional<std::string> output, plot;
  std::optional<std::string> resume;  ///< a file with the state to begin from
};

/// `orbit --over w=1:0.01:3`: the orbit of each value from that of the one before, as a table with the
/// columns w, period, stable, largest_multiplier, impacts, event, and the state: each coordinate, each
/// velocity.
Answer orbit_branch(const std::string& file, const Problem&, const mechanics::OrbitQuestion&,
                    const OrbitOptions&);

}  // namespace cli::inline commands
