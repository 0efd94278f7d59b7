#pragma once

#include <vector>

#include "mechanics/expression/rounded.hpp"
#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// The nodes of a tape that depend on nothing, or on nothing but t, with what rounding may have done to them:
/// decimals count as written, 9.81 is 981/100. The others are left 0.
std::vector<Rounded> rounded_nodes(const Tape& tape, Rounded t = {});

}  // namespace mechanics::expression
