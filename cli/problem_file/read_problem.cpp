#include <algorithm>
#include <array>
#include <memory>

#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/exact_projection.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/problem_file/tables.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;

constexpr std::array kinds{"system", "projection", "decomposition", "cone", "liquid"};

/// The one table that says what the file is about.
const TomlEntry& content_table(const TomlValue& document) {
  const TomlEntry* found = nullptr;
  for (const TomlEntry& entry : document.table) {
    if (std::find(kinds.begin(), kinds.end(), entry.key) == kinds.end()) continue;
    if (found != nullptr)
      throw InvalidInput("both [" + found->key + "] and [" + entry.key + "]; a file holds one problem",
                         entry.place);
    found = &entry;
  }
  if (const TomlValue* bodies = document.find("bodies"); found == nullptr && bodies != nullptr)
    throw InvalidInput("[bodies] alone is no mechanism yet; give a table [system], which may be empty",
                       bodies->place);
  if (found == nullptr)
    throw InvalidInput(
        "no problem here; give a table [system] (a mechanism), [projection] (numbers), [decomposition] (a "
        "convex function), [cone] (a polyhedral cone) or [liquid] (the inception of cavitation)",
        convex::Place{1, 1});
  return *found;
}

}  // namespace

Problem read_problem(const std::string& text, const std::string& directory) {
  return read_problem(parse_toml(text), directory);
}

Problem read_problem(const TomlValue& given, const std::string& directory) {
  const auto kept = std::make_shared<TomlValue>(given);
  write_long_integers_out(*kept, directory);
  const TomlValue& document = *kept;
  require_known_keys(document, "",
                     {"title", "system", "state", "projection", "decomposition", "cone", "liquid", "solve",
                      "simulate", "draw", "bodies"});
  Problem problem;
  if (const TomlValue* title = document.find("title")) problem.title = shown(require_string(*title, "title"));
  if (const TomlValue* settings = document.find("solve")) problem.solve = read_solve_settings(*settings);
  if (const TomlValue* simulate = document.find("simulate"))
    problem.simulate = read_simulate_settings(*simulate);
  const TomlEntry& content = content_table(document);
  require_table(content.value, content.key);
  const TomlValue* state = document.find("state");
  if (content.key != "system" && state != nullptr)
    throw InvalidInput("[state] goes with [system] only; take it out", state->place);
  const TomlValue* draw = document.find("draw");
  if (content.key != "system" && draw != nullptr)
    throw InvalidInput("[draw] goes with [system] only; take it out", draw->place);
  const TomlValue* bodies = document.find("bodies");
  if (content.key != "system" && bodies != nullptr)
    throw InvalidInput("[bodies] goes with [system] only; take it out", bodies->place);
  if (draw != nullptr) problem.draw = read_draw(*draw);
  if (content.key == "system") {
    problem.content = read_system(document, directory);
  } else if (content.key == "projection") {
    ProjectionProblem projection = read_projection(content.value, directory);
    projection.are_doubles = is_made_of_doubles(content.value);
    if (!projection.are_doubles) {
      projection.exact = [kept, &table = content.value, rounded = projection.problem] {
        return read_exact_projection(table, rounded);
      };
      projection.problem.radii = rounded_rows(content.value, projection.problem);
    }
    problem.content = std::move(projection);
  } else if (content.key == "decomposition") {
    problem.content = read_decomposition(content.value, directory);
  } else if (content.key == "liquid") {
    problem.content = read_liquid(content.value);
  } else {
    problem.content = read_cone(content.value, directory);
  }
  return problem;
}

}  // namespace cli::inline problem_files
