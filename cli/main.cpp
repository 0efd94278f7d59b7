#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <string>

#include "cli/commands/command_line.hpp"
#include "convex/nearest_name.hpp"

namespace {

using cli::Exit;

constexpr const char* version = "moreau " MOREAU_VERSION;

int wrong(const std::string& message) {
  std::fprintf(stderr, "moreau: %s\n", message.c_str());
  return static_cast<int>(Exit::wrong_input);
}

/// A message about a first argument that is no command, with the nearest one; "" when it is one, or an
/// option.
std::string unknown_command(const CLI::App& app, const std::string& first) {
  if (first.rfind('-', 0) == 0) return "";
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == first) return "";
    if (!command->get_group().empty()) known.push_back(command->get_name());
  }
  return "unknown command \"" + first + "\"; did you mean \"" + convex::nearest_name(first, known) + "\"?";
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"moreau: convex analysis and the mechanics of one-sided constraints (J. J. Moreau 1966)"};
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  cli::Work chosen;
  for (const auto add : {cli::add_solve, cli::add_check, cli::add_derive, cli::add_simulate, cli::add_orbit,
                         cli::add_prox, cli::add_conjugate, cli::add_functions, cli::add_methods,
                         cli::add_gallery, cli::add_chart, cli::add_stress})
    add(app, chosen);

  if (argc > 1)
    if (const std::string unknown = unknown_command(app, argv[1]); !unknown.empty()) return wrong(unknown);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    return 0;
  } catch (const CLI::CallForVersion&) {
    std::puts(version);
    return 0;
  } catch (const CLI::ParseError& error) {
    if (argc < 2) std::fputs(app.help().c_str(), stderr);
    return wrong(std::string(error.what()) + "; see `moreau --help`");
  }
  try {
    return static_cast<int>(chosen());
  } catch (const std::exception& error) {
    return wrong(std::string("a defect of this program: ") + error.what() + "; please report it");
  }
}
