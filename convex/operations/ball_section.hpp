#pragma once

#include "convex/gamma0/function.hpp"

namespace convex::inline operations {

/// x -> f(Ax + b) where f is the indicator of a Euclidean ball and AᵀA = α times the identity, α > 0, as of
/// any A with one column: by |Ax + e|² = α |x + Aᵀe/α|² + |e|² - |Aᵀe|²/α, e = b - center, a ball again, a
/// point where the plane of Ax + b touches the first one. Which it is, is decided in fractions. Throws
/// InvalidInput where the plane misses the ball; none for other f and A.
std::optional<Function> ball_section(const Function& f, const Matrix& A, const Vector& b);

}  // namespace convex::inline operations
