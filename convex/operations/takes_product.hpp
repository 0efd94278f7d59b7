#pragma once

#include "convex/gamma0/call.hpp"

namespace convex::inline operations {

/// Do the values of a function depend on the product of its space? Those of `conjugate`, `support`,
/// `envelope` and `proximal_average` do, and of what has them as a part. Inside `precompose`, `perspective`
/// and `epigraph` the product is the plain one. A function of the space with W is then another one than that
/// of the same call in the space with W/gamma.
bool takes_product(const Call& call);

}  // namespace convex::inline operations
