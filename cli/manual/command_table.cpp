#include "cli/manual/command_table.hpp"

#include <CLI/CLI.hpp>

#include "cli/manual/help_topics.hpp"
#include "cli/manual/starting_files.hpp"
#include "convex/catalogue/catalogue.hpp"
#include "convex/nearest_point/gallery/gallery.hpp"
#include "convex/nearest_point/methods.hpp"

namespace cli::inline manual {
namespace {

/// The name of each member of a table.
std::vector<std::string> names_in(const auto& table) {
  std::vector<std::string> names;
  for (const auto& member : table) names.emplace_back(member.name);
  return names;
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The words that may stand there, of what has a table in the program.
std::vector<std::string> choices_of(const CLI::App& program, const std::string& command,
                                    const std::string& name) {
  if (name == "--method" && command == "simulate") return {"event-driven", "time-stepping"};
  if (name == "--method" || name == "--relative") return names_in(convex::methods());
  if (name == "--model") return {"reduced", "full"};
  if (name == "--error") return {"acceleration", "multipliers"};
  if (name == "FAMILY") return names_in(convex::gallery());
  if (name == "KIND") return names_in(starting_files());
  if (name == "SHELL") return {"bash", "zsh", "fish"};
  if (name == "NAME" && command == "functions") return names_in(convex::catalogue());
  if (name == "TOPIC") {
    std::vector<std::string> topics = names_in(help_topics());
    for (const std::string& known : command_names(program)) topics.push_back(known);
    return topics;
  }
  return {};
}

HelpLine line_of(const CLI::App& program, const CLI::App& command, const CLI::Option& option) {
  HelpLine line;
  for (const std::string& name : option.get_snames()) line.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) line.names.push_back("--" + name);
  if (option.get_positional()) line.names = {option.get_name(true)};
  if (option.get_items_expected_max() > 0 && !option.get_positional()) {
    const std::string type = option.get_type_name();  // behind a colon: what checks it
    line.value = type.substr(0, type.find(':'));
  }
  line.help = option.get_description();
  line.choices = choices_of(program, command.get_name(), line.names.back());
  line.required = option.get_required();
  line.repeats = option.get_expected_max() > 1 || option.get_allow_extra_args() ||
                 option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  return line;
}

}  // namespace

CommandTable command_table(const CLI::App& program) {
  CommandTable table{program.get_description(), {}};
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    CommandLines lines{command->get_name(), command->get_description(), {}, {}};
    for (const CLI::Option* option : command->get_options())
      (option->get_positional() ? lines.arguments : lines.options)
          .push_back(line_of(program, *command, *option));
    table.commands.push_back(std::move(lines));
  }
  return table;
}

}  // namespace cli::inline manual
