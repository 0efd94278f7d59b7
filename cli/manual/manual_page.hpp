#pragma once

#include <string>

#include "cli/manual/command_table.hpp"

namespace cli::inline manual {

/// moreau(1): a page for man, of the commands with their options and the topics of `moreau help`.
std::string manual_page(const CommandTable&, const std::string& version);

}  // namespace cli::inline manual
