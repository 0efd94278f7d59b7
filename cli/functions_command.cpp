#include <fmt/format.h>

#include <cstdio>

#include "cli/catalogue_report.hpp"
#include "cli/commands.hpp"
#include "cli/each_file.hpp"
#include "convex/nearest_name.hpp"

namespace cli {
namespace {

/// The entries that are asked for: all, or the one that is named.
std::vector<CatalogueLine> chosen(const Options& options) {
  if (!options.function) return catalogue_lines();
  const convex::CatalogueEntry* entry = convex::find_entry(*options.function);
  if (entry != nullptr) return {catalogue_line(*entry)};
  std::vector<std::string> names;
  for (const convex::CatalogueEntry& known : convex::catalogue()) names.emplace_back(known.name);
  throw convex::InvalidInput("there is no set, function or operation \"" + *options.function +
                             "\"; did you mean \"" + convex::nearest_name(*options.function, names) + "\"?");
}

}  // namespace

Exit functions_command(const Options& options) {
  const Source source{options.function.value_or("functions"), ""};
  return answered(options, source, [&] {
    const std::vector<CatalogueLine> lines = chosen(options);
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

}  // namespace cli
