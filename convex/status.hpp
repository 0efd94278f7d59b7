#pragma once

namespace convex {

/// How a solve ended. `solved`: the error bound is within the accuracy asked for; for a nearest point, at
/// most tolerance * max(1, ||q||_A).
enum class Status { solved, inaccurate, infeasible, gave_up };

}  // namespace convex
