#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline problem_files {

SolveSettings read_solve_settings(const TomlValue& table) {
  convex::Mistakes mistakes;
  mistakes.gather([&] {
    require_known_keys(require_table(table, "solve"), "solve", {"method", "tolerance", "contact_tolerance"});
  });
  SolveSettings settings;
  if (const TomlValue* method = table.find("method"))
    mistakes.gather([&] {
      settings.method = require_string(*method, "solve.method");
      settings.method_place = method->place;
    });
  if (const TomlValue* tolerance = table.find("tolerance"))
    mistakes.gather([&] { settings.tolerance = require_positive(*tolerance, "solve.tolerance"); });
  if (const TomlValue* tolerance = table.find("contact_tolerance")) {
    settings.contact_tolerance_place = tolerance->place;
    if (tolerance->kind != TomlValue::Kind::table)
      mistakes.gather(
          [&] { settings.contact_tolerance = require_positive(*tolerance, "solve.contact_tolerance"); });
    for (const TomlEntry& entry : tolerance->table)
      mistakes.gather([&] {
        settings.contact_tolerances.push_back(
            {entry.key, entry.place,
             require_positive(entry.value, "solve.contact_tolerance." + shown(entry.key))});
      });
  }
  mistakes.tell();
  return settings;
}

const convex::Method& require_method(const std::string& name, const std::string& option,
                                     std::optional<convex::Place> place) {
  if (const convex::Method* method = convex::find_method(name)) return *method;
  std::vector<std::string> known;
  for (const convex::Method& method : convex::methods()) known.emplace_back(method.name);
  throw convex::InvalidInput(option + "unknown method \"" + name + "\"; " +
                                 convex::suggestion(name, known, "`moreau methods` lists them"),
                             place);
}

}  // namespace cli::inline problem_files
