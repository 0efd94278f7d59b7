#pragma once

#include <span>
#include <string_view>

namespace cli::inline manual {

/// What `moreau help NAME` tells besides the commands, and the sections of the manual page.
struct HelpTopic {
  std::string_view name, summary;  ///< each one line
  std::string_view text;           ///< lines of at most 100 characters, as they are printed
};

/// The one table of topics.
std::span<const HelpTopic> help_topics();

}  // namespace cli::inline manual
