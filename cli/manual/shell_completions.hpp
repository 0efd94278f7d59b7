#pragma once

#include <string>

#include "cli/manual/command_table.hpp"

namespace cli::inline manual {

/// Functions for a shell that complete commands, options, the words that an option takes, and files.
std::string bash_completions(const CommandTable&);
std::string zsh_completions(const CommandTable&);
std::string fish_completions(const CommandTable&);

}  // namespace cli::inline manual
