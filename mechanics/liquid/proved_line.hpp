#pragma once

#include "mechanics/liquid/line_scene.hpp"

namespace mechanics::liquid {

/// A proved bound of |p - p*|, in place of the estimate, for the scene as it is written (decimals count as
/// written): ends, h and what is given at the ends are enclosed, and p lies between a sub- and a
/// supersolution (convex::enclose_line). That a scene is radial is taken as seen (CoordinateForm:
/// coefficients equal to their rounding). Leaves `found` as it is where this proves nothing: where it is in
/// doubt which part has an end, where an inequality's ends are not simple roots, where h is no function to be
/// enclosed, and without a given pressure if walls and h leave no cavity.
void prove_line(const LiquidScene&, const LineScene&, const LiquidAccuracy&, LiquidSolution& found);

}  // namespace mechanics::liquid
