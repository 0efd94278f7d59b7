#pragma once

#include <string>

#include "cli/options.hpp"

namespace cli {

struct FunctionOptions;

/// `--symbolic`: f of one variable with its prox, or its conjugate, by cases; `--latex`: as formulas of
/// amsmath.
Exit tell_prox_in_symbols(const FunctionOptions&);
Exit tell_conjugate_in_symbols(const FunctionOptions&);

}  // namespace cli
