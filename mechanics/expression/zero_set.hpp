#pragma once

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// g with {f = 0} = {g = 0} for a node f that is a power of g, or a product of g with itself, times or over
/// constants that are not 0: its gradient vanishes wherever f = 0, that of g need not. f itself where it is
/// none.
NodeId base_of_power(const Tape&, NodeId f);

}  // namespace mechanics::expression
