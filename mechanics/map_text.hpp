#pragma once

#include <memory>

#include "convex/laws/map_laws.hpp"
#include "mechanics/lagrangian_text.hpp"

namespace mechanics {

/// The map whose components are these expressions, in x where there is one, else in x1, x2, …; the language
/// is that of problem files. At a point it is evaluated in fractions; what is none (a sine, a root) in balls,
/// or where there are none, and at kinks, in doubles, with the radius of what these may be off. Throws
/// InvalidInput with the place.
convex::Map map_of_text(const std::vector<Text>& components);

}  // namespace mechanics
