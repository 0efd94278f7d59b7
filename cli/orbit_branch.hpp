#pragma once

#include <string>

#include "cli/answer.hpp"
#include "cli/problem_file/problem.hpp"
#include "mechanics/motion/orbit.hpp"

namespace cli {

/// The value of an expression in the parameters of a file. `where` names it in messages.
double value_of(const Problem&, const mechanics::LagrangianSystem&, const std::string& expression,
                const std::string& where);

/// `orbit --over w=1:0.01:3`: the orbit of each value from that of the one before, as a table with the
/// columns w, period, stable, largest_multiplier, impacts, event.
Answer orbit_branch(const std::string& file, const Problem&, const mechanics::OrbitQuestion&, const Options&);

}  // namespace cli
