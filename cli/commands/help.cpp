#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/manual/help_topics.hpp"
#include "cli/manual/manual_page.hpp"
#include "cli/report/catalogue_report.hpp"
#include "convex/invalid_input.hpp"
#include "convex/nearest_name.hpp"
#include "convex/nearest_point/methods.hpp"

namespace cli::inline commands {
namespace {

/// What `moreau help` is told.
struct HelpOptions : Printing {
  std::optional<std::string> topic;
  bool manual = false;  ///< moreau(1), for man
};

std::string topic_list() {
  std::string text = "Topics of `moreau help TOPIC`, besides the commands, the functions and the methods:\n";
  for (const HelpTopic& topic : help_topics())
    text += fmt::format("  {:<12} {}\n", topic.name, topic.summary);
  return text;
}

bool has_word(std::string_view text, const std::string& word) {
  const auto is_of_word = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_');
  };
  if (word.empty()) return false;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1))
    if (!(at > 0 && is_of_word(at - 1)) && !is_of_word(at + word.size())) return true;
  return false;
}

/// The help on a topic, a command, a function or a method.
std::string help_text(CLI::App& program, const std::string& name) {
  std::vector<std::string> known;
  for (const HelpTopic& topic : help_topics()) {
    if (topic.name == name) return fmt::format("{}: {}\n\n{}", topic.name, topic.summary, topic.text);
    known.emplace_back(topic.name);
  }
  for (CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == name) return command->help("moreau");
    known.push_back(command->get_name());
  }
  if (const convex::CatalogueEntry* entry = convex::find_entry(name))
    return catalogue_details(catalogue_line(*entry));
  if (const convex::Method* method = convex::find_method(name))
    return fmt::format("{}: {}\n", method->name, method->summary);
  for (const convex::CatalogueEntry& entry : convex::catalogue()) known.emplace_back(entry.name);
  for (const convex::Method& method : convex::methods()) known.emplace_back(method.name);
  for (const HelpTopic& topic : help_topics())
    if (has_word(topic.text, name))
      throw convex::InvalidInput(
          fmt::format("there is no topic \"{}\"; `moreau help {}` tells of it", name, topic.name));
  throw convex::InvalidInput("there is no topic \"" + name + "\"; " +
                             convex::suggestion(name, known, "`moreau help` lists them"));
}

Exit help(CLI::App& program, const HelpOptions& options) {
  return answered(options, {"TOPIC", options.topic.value_or("")}, [&] {
    if (options.manual)
      fmt::print("{}", manual_page(command_table(program), program.version()));
    else if (options.topic)
      fmt::print("{}", help_text(program, *options.topic));
    else
      fmt::print("{}\n{}", program.get_formatter()->make_help(&program, "moreau", CLI::AppFormatMode::Normal),
                 topic_list());
    return Exit::solved;
  });
}

}  // namespace

void add_help(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<HelpOptions>();
  CLI::App& command = add_command(program, "help", "help on a command, a function, a method or a topic",
                                  chosen, [options, &program] { return help(program, *options); });
  command.add_option("TOPIC", options->topic, "what to tell about; without it, all topics are listed");
  command.add_flag("--man", options->manual, "the manual page moreau(1), for man");
}

}  // namespace cli::inline commands
