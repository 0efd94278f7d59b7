#pragma once

#include "mechanics/liquid/domain.hpp"

namespace mechanics::liquid {

/// Finds a box around a domain by inequalities. Throws InvalidInput where no point of it is found or it does
/// not end.
void find_box(Domain&, convex::Place);

}  // namespace mechanics::liquid
