#pragma once

#include <string>

#include "mechanics/lagrangian_text.hpp"
#include "mechanics/system.hpp"

namespace cli {

/// The state at which a motion ended, from the JSON that `moreau simulate --json` printed: `t`, `position`,
/// `velocity`. Throws InvalidInput, naming the file, where they are not those of the system.
mechanics::State resumed_state(const std::string& file, const mechanics::System&);

/// A state as the text of a file.
mechanics::StateText state_text(const mechanics::State&, const mechanics::System&);

}  // namespace cli
