#include "cli/commands/program.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
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

/// "`moreau simulate` has it", of the commands that have an option; "" for none.
std::string who_has(const CLI::App& app, const std::string& option) {
  std::vector<std::string> found;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (command->get_option_no_throw(option) != nullptr && !command->get_group().empty())
      found.push_back("`moreau " + command->get_name() + "`");
  if (found.size() <= 1) return found.empty() ? "" : found.front() + " has it";
  return found[0] + (found.size() == 2 ? " and " : ", ") + found[1] +
         (found.size() == 2 ? " have it" : " and others have it");
}

/// What to do about "-o" or "-at": the one option whose name begins so.
std::string with_two_dashes(const std::string& given, const std::vector<std::string>& known) {
  std::vector<std::string> begun;
  for (const std::string& name : known)
    if (name.starts_with(given.substr(1))) begun.push_back(name);
  const bool is_one =
      begun.size() == 1 || std::find(begun.begin(), begun.end(), given.substr(1)) != begun.end();
  if (!is_one) return "options have two dashes";
  return "did you mean --" + (begun.size() == 1 ? begun.front() : given.substr(1)) + "?";
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
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back(name);
  if (found == left.end()) {
    if (left.empty()) return "";
    const std::string& first = left.front();
    if (first.size() > 1 && first[0] == '-' && std::isalpha(static_cast<unsigned char>(first[1])) != 0)
      return command.get_name() + " has no option " + first + "; " + with_two_dashes(first, known);
    const CLI::Option* at = first[0] == '[' ? command.get_option_no_throw("--at") : nullptr;
    const bool is_point = at != nullptr && at->empty();
    return "\"" + first + "\" is more than " + command.get_name() + " takes; " +
           (is_point ? "a point stands behind --at, --at \"" + first + "\"" : help_on(app));
  }
  const std::string name = found->substr(2, found->find('=') - 2);
  const std::string has_none = command.get_name() + " has no option --" + name + "; ";
  const bool takes_settings = std::find(known.begin(), known.end(), "set") != known.end();
  for (const char* key : {"step", "samples", "restitution", "impact_law"})
    if (takes_settings && name == key)
      return has_none + "it is a key of the file, --set \"simulate." + key + "=…\"";
  if (std::find(known.begin(), known.end(), name) != known.end())
    return "--" + name + " stands before the command; write it behind, `moreau " + command.get_name() +
           " … --" + name + "`";
  if (const std::string others = who_has(app, "--" + name); !others.empty())
    return has_none + others + ", " + help_on(app);
  const std::string nearest = convex::nearest_name(name, known);
  return has_none + (nearest.empty() ? help_on(app) : "did you mean --" + nearest + "?");
}

/// "--until: "x" is no number", of CLI11's own "Could not convert: --until = x"; "--until: no value behind
/// it", of "--until: 1 required T missing".
std::string in_own_words(const std::string& said) {
  const std::string before = ": 1 required ", behind = " missing";
  if (const std::size_t at = said.find(before); at != std::string::npos && said.ends_with(behind)) {
    const std::string option = said.substr(0, at), value = said.substr(at + before.size());
    return option + ": no value behind it; write " + option + " " +
           value.substr(0, value.size() - behind.size());
  }
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
