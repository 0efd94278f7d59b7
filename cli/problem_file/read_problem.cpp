#include <algorithm>
#include <iterator>
#include <memory>

#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/exact_projection.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/kinds.hpp"
#include "cli/problem_file/problem.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/mistakes.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;

bool is_unknown_table(const TomlEntry& entry) {
  return entry.value.kind == TomlValue::Kind::table &&
         std::find(top_keys.begin(), top_keys.end(), entry.key) == top_keys.end();
}

/// The one table that says what the file is about.
const TomlEntry& content_table(const TomlValue& document) {
  const TomlEntry* found = nullptr;
  for (const TomlEntry& entry : document.table) {
    if (std::none_of(std::begin(problem_kinds), std::end(problem_kinds),
                     [&](const ProblemKind& kind) { return entry.key == kind.name; }))
      continue;
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

ProjectionProblem read_numbers(const std::shared_ptr<TomlValue>& document, const TomlValue& table,
                               const std::string& directory) {
  ProjectionProblem projection = read_projection(table, directory);
  projection.are_doubles = is_made_of_doubles(table);
  if (projection.are_doubles) return projection;
  projection.exact = [document, &table, rounded = projection.problem] {
    return read_exact_projection(table, rounded);
  };
  projection.problem.radii = rounded_rows(table, projection.problem);
  return projection;
}

}  // namespace

Problem read_problem(const std::string& text, const std::string& directory) {
  return read_problem(parse_toml(text), directory);
}

Problem read_problem(const TomlValue& given, const std::string& directory) {
  const auto kept = std::make_shared<TomlValue>(given);
  write_long_integers_out(*kept, directory);
  Problem problem;
  convex::Mistakes mistakes;
  mistakes.gather([&] { require_known_keys(*kept, "", top_keys); });
  if (!mistakes.none()) *kept = with_keys_at_home(with_meant_keys(std::move(*kept), top_keys));
  move_strays_home(*kept, mistakes);
  const TomlValue& document = *kept;
  const auto read = [&](const char* key, const auto& work) {
    if (const TomlValue* value = document.find(key)) mistakes.gather([&] { work(*value); });
  };
  read("title", [&](const TomlValue& title) { problem.title = shown(require_string(title, "title")); });
  read("solve", [&](const TomlValue& settings) { problem.solve = read_solve_settings(settings); });
  read("simulate", [&](const TomlValue& settings) { problem.simulate = read_simulate_settings(settings); });
  // What stands in a table with a wrong name may be what the others need.
  if (std::any_of(document.table.begin(), document.table.end(), is_unknown_table)) mistakes.tell();
  const TomlEntry* content = nullptr;
  if (!mistakes.gather([&] { content = &content_table(document); })) mistakes.tell();
  const bool is_system = content->key == "system";
  for (const char* key : {"state", "draw", "bodies"})
    read(key, [&](const TomlValue& table) {
      if (!is_system)
        throw InvalidInput("[" + std::string(key) + "] goes with [system] only; take it out", table.place);
    });
  if (is_system) {
    read("draw", [&](const TomlValue& draw) { problem.draw = read_draw(draw); });
    problem.content = read_system(document, directory, mistakes);
  }
  mistakes.gather([&] {
    require_table(content->value, content->key);
    if (content->key == "projection") problem.content = read_numbers(kept, content->value, directory);
    if (content->key == "decomposition") problem.content = read_decomposition(content->value, directory);
    if (content->key == "liquid") problem.content = read_liquid(content->value);
    if (content->key == "cone") problem.content = read_cone(content->value, directory);
  });
  // A method that is told elsewhere may win over this one; beside what is wrong in the file it is told at
  // once.
  const bool has_method = is_system || content->key == "projection";
  if (!mistakes.none() && problem.solve.method && has_method)
    mistakes.gather([&] { require_method(*problem.solve.method, "", problem.solve.method_place); });
  mistakes.tell();
  return problem;
}

}  // namespace cli::inline problem_files
