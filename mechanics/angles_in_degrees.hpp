#pragma once

#include <string>
#include <vector>

#include "convex/invalid_input.hpp"

namespace mechanics {

class LagrangianSystem;
struct State;

/// A sentence for each sine, cosine or tangent of a whole number beyond a turn, as sin(30): it is in radians,
/// and was hardly meant so.
std::vector<std::string> angles_in_degrees(const LagrangianSystem&);

/// These, and one for each coordinate that is an angle and stands at such a number. It is one where it occurs
/// in sums alone of which a sine, cosine or tangent is taken, and in derivatives, and where no coordinate
/// that occurs elsewhere has the same inertia: that of a length x beside y >= sin(x) is that of y.
std::vector<std::string> angles_in_degrees(const LagrangianSystem&, const State&);

/// Why a state is refused, told with such an angle, which may be the cause. `place`: of an error without one.
convex::InvalidInput refused_state(const convex::InvalidInput& error, convex::Place place,
                                   const LagrangianSystem&, const State&);

}  // namespace mechanics
