#pragma once

#include <span>
#include <string_view>

namespace cli::inline manual {

/// A problem file to begin with: it solves as it stands, and says at each line what to change.
struct StartingFile {
  std::string_view name, summary;  ///< each one line
  std::string_view text;
};

/// The one table of them, by kind.
std::span<const StartingFile> starting_files();

}  // namespace cli::inline manual
