#pragma once

#include "convex/gamma0/call.hpp"
#include "convex/symbolic/function.hpp"

namespace convex::symbolic {

/// The function of one variable that a call of the language stands for. Numbers count as the simplest
/// fractions that round to them (`simplest_fraction`): "1/3" is a third. `weight`: w of the product w x y,
/// which conjugates, envelopes and support functions in the call are those of. Throws InvalidInput for a name
/// that has no rule here, with the place.
Function function_of(const Call&, const Fraction& weight = {1, 1});

}  // namespace convex::symbolic
