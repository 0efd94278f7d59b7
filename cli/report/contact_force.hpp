#pragma once

#include <optional>

#include "cli/scene.hpp"

namespace cli::inline reports {

/// What lambda_a is to be multiplied by for the force of the contact, where that is another number: |∂f_a/∂q|
/// of the point that the contact is on, or of either of two that it is between. None where f is a distance
/// (that is 1, or a coordinate moves f one for one), where a coordinate is an angle (all that the contact
/// says of it comes back after 2 pi), and where f is linear in several coordinates, as for a lever or a gear,
/// whose units nothing tells. How a body is turned has no part in it.
std::optional<double> force_per_multiplier(const Scene&, convex::Index constraint);

}  // namespace cli::inline reports
