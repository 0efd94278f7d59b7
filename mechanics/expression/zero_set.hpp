#pragma once

#include "mechanics/expression/tape.hpp"

namespace mechanics::expression {

/// g with {f = 0} = {g = 0} for a node f that is a product of powers, times or over constants that are not 0:
/// the product of their bases, each once. The gradient of f vanishes wherever a base of a power is 0, that of
/// g need not. f itself where no base stands there more than once.
NodeId base_of_power(Tape&, NodeId f);

}  // namespace mechanics::expression
