#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>

#include "cli/commands.hpp"

namespace {

using cli::Exit;
using cli::Options;

constexpr const char* version = "moreau " MOREAU_VERSION;

/// Commands of the contract that a later version brings.
constexpr std::array planned{"check", "simulate",  "chart",   "stress",
                             "prox",  "conjugate", "gallery", "functions"};

int wrong(const std::string& message) {
  std::fprintf(stderr, "moreau: %s\n", message.c_str());
  return static_cast<int>(Exit::wrong_input);
}

void add_common(CLI::App& command, Options& options) {
  command.add_flag("--json", options.json, "one JSON object per file, one per line, on standard output");
  command.add_flag("--quiet", options.quiet, "no text; the exit code tells");
}

void add_files(CLI::App& command, Options& options) {
  command.add_option("FILE", options.files, "problem files; - is standard input")->required();
  command.add_option("--method", options.method, "method of solution (see `moreau methods`)")
      ->type_name("NAME");
  command
      .add_option("--tolerance", options.tolerance,
                  "accept an error bound of X * max(1, ||q''||_A); default 1e-9")
      ->type_name("X")
      ->check(CLI::PositiveNumber);
  command.add_flag_callback(
      "--certify",
      [] {
        throw CLI::ValidationError(
            "--certify is not available yet; leave it out for an estimated error bound");
      },
      "a proved error bound (not available yet)");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"moreau: the motion of mechanical systems with one-sided constraints (J. J. Moreau 1966)"};
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  Options options;
  std::function<Exit(const Options&)> chosen;

  CLI::App* solve =
      app.add_subcommand("solve", "which contacts persist, with which acceleration and reactions");
  add_files(*solve, options);
  add_common(*solve, options);
  solve->add_flag("--ranges", options.ranges,
                  "ranges of multipliers that are not unique, also beyond 1000 contacts");
  solve->callback([&] { chosen = cli::solve_command; });

  CLI::App* derive = app.add_subcommand("derive", "A, z, U, s of a system at its state");
  add_files(*derive, options);
  add_common(*derive, options);
  derive->callback([&] { chosen = cli::derive_command; });

  CLI::App* methods = app.add_subcommand("methods", "the methods of solution that a file can name");
  add_common(*methods, options);
  methods->callback([&] { chosen = cli::methods_command; });

  for (const char* name : planned) {
    CLI::App* later = app.add_subcommand(name, "not available yet")->group("")->allow_extras();
    later->callback([name] {
      throw CLI::ValidationError(std::string("`moreau ") + name +
                                 "` is not available yet; see `moreau --help` for what is");
    });
  }

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
    return wrong(std::string(error.what()) + (argc < 2 ? "; name a command" : ""));
  }
  try {
    return static_cast<int>(chosen(options));
  } catch (const std::exception& error) {
    return wrong(std::string("a defect of this program: ") + error.what() + "; please report it");
  }
}
