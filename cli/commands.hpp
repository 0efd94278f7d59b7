#pragma once

#include "cli/options.hpp"

namespace cli {

/// `moreau solve FILE…`: solves each problem file.
Exit solve_command(const Options&);

/// `moreau derive FILE…`: A, z, U, s of a system at its state.
Exit derive_command(const Options&);

/// `moreau methods`: the methods of solution that a file can name.
Exit methods_command(const Options&);

}  // namespace cli
