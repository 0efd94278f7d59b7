#pragma once

#include <optional>

#include "cli/commands/command_line.hpp"

namespace cli::inline commands {

/// `--symbolic`: f of one variable with the prox of step f, or its conjugate, by cases; `--latex`: as
/// formulas of amsmath.
Exit tell_prox_in_symbols(const FunctionOptions&, std::optional<double> step);
Exit tell_conjugate_in_symbols(const FunctionOptions&);

}  // namespace cli::inline commands
