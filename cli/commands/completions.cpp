#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/manual/shell_completions.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline commands {
namespace {

Exit completions(const CLI::App& program, const std::string& shell) {
  return answered({}, {"SHELL", shell}, [&] {
    if (shell == "bash")
      fmt::print("{}", bash_completions(command_table(program)));
    else if (shell == "zsh")
      fmt::print("{}", zsh_completions(command_table(program)));
    else if (shell == "fish")
      fmt::print("{}", fish_completions(command_table(program)));
    else
      throw convex::InvalidInput("there are no completions for \"" + shell + "\"; " +
                                 convex::suggestion(shell, {"bash", "zsh", "fish"}));
    return Exit::solved;
  });
}

}  // namespace

void add_completions(CLI::App& program, Work& chosen) {
  const auto shell = std::make_shared<std::string>();
  CLI::App& command = add_command(program, "completions", "completion of commands and options in a shell",
                                  chosen, [shell, &program] { return completions(program, *shell); });
  command.add_option("SHELL", *shell, "bash, zsh or fish")->required();
}

}  // namespace cli::inline commands
