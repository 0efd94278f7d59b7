#pragma once

#include <functional>

#include "cli/options.hpp"

namespace cli {

/// Does `work` for every file and returns the largest exit code. This is the one place where InvalidInput
/// becomes a message: `moreau: FILE:LINE:COLUMN: what is wrong; what to do` on standard error, and a JSON
/// object under --json.
Exit for_each_file(const Options& options, const std::function<Exit(const std::string& file)>& work);

}  // namespace cli
