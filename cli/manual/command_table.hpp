#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace cli::inline manual {

/// An option of a command, or one of its arguments, as its help tells it.
struct HelpLine {
  std::vector<std::string> names;    ///< "-o", "--output"; of an argument its one name
  std::string value;                 ///< what goes behind an option, "F.csv"; "" for a flag
  std::string help;                  ///< one sentence
  std::vector<std::string> choices;  ///< every word that may stand there, where these can be listed
  bool required = false, repeats = false;
};

/// A command: its name, what it does, its arguments in order, its options.
struct CommandLines {
  std::string name, help;
  std::vector<HelpLine> arguments, options;
};

/// All that the program's --help knows. The manual page and the completions of shells are written from it, so
/// that none of them can name what the others do not.
struct CommandTable {
  std::string help;
  std::vector<CommandLines> commands;
};

/// The table of a program whose commands were added.
CommandTable command_table(const CLI::App& program);

}  // namespace cli::inline manual
