#pragma once

#include <vector>

#include "mechanics/expression/tape.hpp"

namespace mechanics::inline motions {

/// By node, whether it, or one that it is of, may jump or have a kink of which its series before do not tell:
/// at a pole, where an atan2 jumps, and at a root of what comes to 0.
std::vector<bool> nodes_that_may_jump(const expression::Tape& tape);

/// By node, whether there are quotients and powers among these, and nothing else.
std::vector<bool> nodes_of_quotients(const expression::Tape& tape);

}  // namespace mechanics::inline motions
