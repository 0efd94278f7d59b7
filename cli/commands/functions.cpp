#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <cstdio>

#include "cli/commands/command_line.hpp"
#include "cli/each_file.hpp"
#include "cli/report/catalogue_report.hpp"

namespace cli::inline commands {
namespace {

/// What `moreau functions` is told.
struct FunctionsOptions : Printing {
  std::optional<std::string> function;  ///< the one to tell about
  bool markdown = false;                ///< docs/functions.md
};

/// The entries that are asked for: all, or the one that is named.
std::vector<CatalogueLine> entries(const FunctionsOptions& options) {
  if (!options.function) return catalogue_lines();
  const convex::CatalogueEntry* entry = convex::find_entry(*options.function);
  if (entry != nullptr) return {catalogue_line(*entry)};
  throw convex::InvalidInput(convex::unknown_entry(*options.function));
}

Exit tell_functions(const FunctionsOptions& options) {
  const Source source{options.function.value_or("functions"), ""};
  return answered(options, source, [&] {
    const std::vector<CatalogueLine> lines = entries(options);
    if (options.json)
      fmt::print("{}\n", catalogue_json(lines));
    else if (options.markdown)
      fmt::print("{}", catalogue_markdown(lines));
    else if (options.function)
      fmt::print("{}", catalogue_details(lines.front()));
    else
      fmt::print("{}", catalogue_text(lines));
    return Exit::solved;
  });
}

}  // namespace

void add_functions(CLI::App& program, Work& chosen) {
  const auto options = std::make_shared<FunctionsOptions>();
  CLI::App& command = add_command(
      program, "functions",
      "the sets, functions and operations: name, arguments, formula, facts, how the prox is found", chosen,
      [options] { return tell_functions(*options); });
  command.add_option("NAME", options->function, "everything about one of them");
  command.add_flag("--json", options->json, "one JSON object on standard output");
  command.add_flag("--markdown", options->markdown, "the page docs/functions.md");
}

}  // namespace cli::inline commands
