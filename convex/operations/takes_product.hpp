#pragma once

#include "convex/gamma0/call.hpp"

namespace convex::inline operations {

/// Do the values of a function depend on the product of its space? Those of `conjugate`, `support`,
/// `envelope` and `proximal_average` do, and of what has them as a part. Inside `precompose`, `perspective`
/// and `epigraph` the product is the plain one. A function of the space with W is then another one than that
/// of the same call in the space with W/gamma.
bool takes_product(const Call& call);

/// The call of a function on n entries in the plain product, to be read in the space with any: before
/// rounding it is that call in the plain product, where it takes one.
Call of_plain_product(Call call, Index n);

}  // namespace convex::inline operations
