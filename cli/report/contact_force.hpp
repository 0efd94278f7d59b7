#pragma once

#include <optional>

#include "cli/scene.hpp"

namespace cli::inline reports {

/// |∂f_a/∂q| where lambda_a times it is the force of the contact and lambda_a alone is not; none where f is a
/// distance (a coordinate moves it one for one), where a coordinate is an angle (all that the contact says of
/// it comes back after 2 pi), and where f is linear in several coordinates, as for a lever or a gear, whose
/// units nothing tells.
std::optional<double> force_per_multiplier(const Scene&, convex::Index constraint);

}  // namespace cli::inline reports
