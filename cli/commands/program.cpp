#include "cli/commands/program.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>

#include "cli/commands/command_line.hpp"
#include "cli/json_writer.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline commands {
namespace {

int wrong(const std::string& message) {
  std::fprintf(stderr, "moreau: %s\n", message.c_str());
  return static_cast<int>(Exit::wrong_input);
}

bool asks_for_json(int argc, char** argv) {
  for (int k = 1; k < argc && std::string_view(argv[k]) != "--"; ++k)
    if (std::string_view(argv[k]) == "--json") return true;
  return false;
}

/// The problem file that a command line names, as far as it was read, rather one that is there; "" for none.
std::string file_of(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands())
    for (const char* name : {"FILE", "IN"}) {
      const CLI::Option* option = command->get_option_no_throw(name);
      if (option == nullptr || option->empty()) continue;
      std::error_code none;
      for (const std::string& file : option->results())
        if (file == "-" || std::filesystem::exists(file, none)) return file;
      return option->results().front();
    }
  return "";
}

/// What is wrong with the command line itself. Who reads JSON has it there too, in one object.
int wrong_command(const CLI::App& app, bool json, const std::string& message) {
  if (json) {
    JsonWriter object;
    object.begin_object().key("file").value(file_of(app)).key("status").value("error");
    object.key("message").value(message).key("line").value(1).key("column").value(1);
    std::puts(object.end_object().text().c_str());
    std::fflush(stdout);
  }
  return wrong(message);
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
  if (first.ends_with(".toml") || first.ends_with(".json"))
    return "a command comes before the file; try `moreau solve " + first + "`";
  return "unknown command \"" + first + "\"; " + convex::suggestion(first, known);
}

/// "see `moreau solve --help`", of the command that was called.
std::string help_on(const CLI::App& app) {
  const auto called = app.get_subcommands();
  return "see `moreau " + (called.empty() ? "" : called.front()->get_name() + " ") + "--help`";
}

/// A message about what the command called does not take, with the nearest of its options; "" when all was
/// taken.
std::string unexpected(const CLI::App& app) {
  const auto called = app.get_subcommands();
  const CLI::App& command = called.empty() ? app : *called.front();
  const std::vector<std::string> left = app.remaining(true);
  const auto option_like = [](const std::string& text) { return text.rfind("--", 0) == 0; };
  const auto found = std::find_if(left.begin(), left.end(), option_like);
  const auto is_negative = [](const std::string& text) {
    return text.rfind('-', 0) == 0 && text.find('(') != std::string::npos;
  };
  if (const auto minus = std::find_if(left.begin(), left.end(), is_negative); minus != left.end())
    return "\"" + *minus +
           "\" begins with a minus; a negative multiple of a convex function is none, give f itself";
  if (found == left.end())
    return left.empty()
               ? ""
               : "\"" + left.front() + "\" is more than " + command.get_name() + " takes; " + help_on(app);
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back(name);
  const std::string name = found->substr(2, found->find('=') - 2);
  const std::string has_none = command.get_name() + " has no option --" + name + "; ";
  const bool takes_settings = std::find(known.begin(), known.end(), "set") != known.end();
  for (const char* key : {"step", "samples", "restitution", "impact_law"})
    if (takes_settings && name == key)
      return has_none + "it is a key of the file, --set \"simulate." + key + "=…\"";
  if (std::find(known.begin(), known.end(), name) != known.end())
    return "--" + name + " stands before the command; write it behind, `moreau " + command.get_name() +
           " … --" + name + "`";
  const std::string nearest = convex::nearest_name(name, known);
  return has_none + (nearest.empty() ? help_on(app) : "did you mean --" + nearest + "?");
}

/// "--until: "x" is no number", of CLI11's own "Could not convert: --until = x".
std::string in_own_words(const std::string& said) {
  const std::string prefix = "Could not convert: ";
  const std::size_t equals = said.find(" = ");
  if (said.rfind(prefix, 0) != 0 || equals == std::string::npos) return said;
  return said.substr(prefix.size(), equals - prefix.size()) + ": \"" + said.substr(equals + 3) +
         "\" is no number here";
}

/// A message about an output that is also what the command reads; "" when there is none.
std::string overwritten(const CLI::App& app) {
  const auto called = app.get_subcommands();
  if (called.empty()) return "";
  const auto is_output = [](const CLI::Option& option) {
    for (const char* name : {"--output", "--plot", "--animate", "--data"})
      if (option.check_name(name)) return true;
    return option.get_name() == "OUT";
  };
  std::vector<std::pair<std::string, std::string>> outputs;
  std::vector<std::string> inputs;
  for (const CLI::Option* option : called.front()->get_options())
    for (const std::string& value : option->results())
      if (is_output(*option))
        outputs.emplace_back(option->get_name(), value);
      else if (option->get_positional())
        inputs.push_back(value);
  for (const auto& [option, output] : outputs)
    for (const std::string& input : inputs) {
      std::error_code none;
      if (std::filesystem::equivalent(output, input, none))
        return option + ": " + output + " is the file that is read, and would be lost; name another";
    }
  return "";
}

int answer(int argc, char** argv, const char* version) {
  CLI::App app{"moreau: convex analysis and the mechanics of one-sided constraints (J. J. Moreau 1966)",
               "moreau"};
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.failure_message(CLI::FailureMessage::simple);
  Work chosen;
  for (const auto add : {add_solve,   add_check,      add_derive,    add_explain,         add_assemble,
                         add_sweep,   add_atlas,      add_simulate,  add_orbit,           add_convert,
                         add_schema,  add_prox,       add_conjugate, add_subdifferential, add_functions,
                         add_methods, add_gallery,    add_chart,     add_stress,          add_new,
                         add_help,    add_completions})
    add(app, chosen);

  const bool json = asks_for_json(argc, argv);
  if (argc > 1)
    if (const std::string unknown = unknown_command(app, argv[1]); !unknown.empty())
      return wrong_command(app, json, unknown);
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
    const std::string message = unexpected(app);
    return wrong_command(app, json,
                         message.empty() ? in_own_words(error.what()) + "; " + help_on(app) : message);
  }
  if (const std::string message = overwritten(app); !message.empty())
    return wrong_command(app, json, message);
  try {
    return static_cast<int>(chosen());
  } catch (const std::exception& error) {
    return wrong(std::string("a defect of this program: ") + error.what() + "; please report it");
  }
}

}  // namespace

int run_program(int argc, char** argv, const char* version) {
  const int exit = answer(argc, argv, version);
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    return wrong("cannot write to standard output; check that the disk has room");
  return exit;
}

}  // namespace cli::inline commands
