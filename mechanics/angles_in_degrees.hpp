#pragma once

#include <string>
#include <vector>

namespace mechanics {

class LagrangianSystem;

/// A sentence for each sine, cosine or tangent of a whole number beyond a turn, as sin(30): it is in radians,
/// and was hardly meant so.
std::vector<std::string> angles_in_degrees(const LagrangianSystem&);

}  // namespace mechanics
