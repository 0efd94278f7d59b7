#pragma once

#include "mechanics/liquid/line_scene.hpp"

namespace mechanics::liquid {

/// A proved bound of |p - p*|, in place of the estimate, for the scene as it is written (decimals count as
/// written), where symmetry and data are plain in the text: h constant, and
///   a disc or ball with one pressure all around;
///   an interval with a pressure at both ends;
///   an interval with a pressure at one end and a wall at the other, h = 0.
/// p becomes a closed form P(·; s) with the edge s of the cavity as a double. For s̄ < s* < s̲, which is
/// proved by P(R; s̄) > p0 > P(R; s̲) in arithmetic with radii, P(·; s̄) is a supersolution (C¹, -ΔP = h <= 0
/// outside of s̄, 0 inside) and P(·; s̲) a subsolution, so that p* lies between them. Leaves `found` as it is
/// where this proves nothing.
void prove_line(const LiquidScene&, const LineScene&, const LiquidAccuracy&, LiquidSolution& found);

}  // namespace mechanics::liquid
