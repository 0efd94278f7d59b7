#pragma once

#include <optional>

#include "mechanics/data_radii.hpp"
#include "mechanics/warning.hpp"

namespace mechanics {

/// The conditions of if, step and sign, and the ties of min and max, that stand at this state between two
/// branches for all that rounding tells: derivatives are those of the branch taken. Ties in a force are left
/// out: its value is the same on both sides, and nothing else of it is used. None when there is nothing to
/// say.
std::optional<Warning> branch_edges(const LagrangianSystem&, const State&, const StateRadii&);

}  // namespace mechanics
