#include "cli/commands/branch_range.hpp"

#include "cli/sweep/sweep_range.hpp"
#include "convex/invalid_input.hpp"

namespace cli::inline commands {

BranchRange branch_range(const std::string& text) {
  if (text.find('=') == std::string::npos || text.find(':') == std::string::npos)
    throw convex::InvalidInput("--over " + text +
                               ": no range; write --over \"w=1:0.01:3\", a parameter, first, step, last");
  SweepRange range = parse_sweep_range(text, 1e6);
  return {range.key, range.values.front(), range.step, range.values.back(), std::move(range.values)};
}

}  // namespace cli::inline commands
