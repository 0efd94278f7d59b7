#pragma once

#include "mechanics/liquid/cut_cells.hpp"

namespace mechanics::liquid {

/// What of ∂p/∂n at walls may hide between the places where a grid asks for it, in p, where it is more than a
/// hundredth of `scale` over the length of the domain: by intervals on pieces of the cells of walls, halved
/// until they tell. A flux that is off by e over a length s makes p off by about e s (1 + log(L/s)) there, as
/// the potential of a charge does.
double hidden_flux(const LiquidScene&, const CutCells&, double scale);

}  // namespace mechanics::liquid
