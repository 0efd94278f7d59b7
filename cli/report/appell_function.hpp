#pragma once

#include <string>

#include "cli/scene.hpp"

namespace cli::inline reports {

/// Appell's function of the accelerations, ½ ∫ Γ² dm - ∫ Γ·dF (Moreau 1966, section 2), without the number in
/// it that does not depend on them, which is Gauss' G = ½ q''·A q'' - z·q'' written out:
/// "0.1 x''^2 + 0.1 y''^2 + 1.962 y''"; `number` writes a coefficient, terms with 0 are left out.
std::string appell_function(const Scene&, std::string (*number)(double));

}  // namespace cli::inline reports
