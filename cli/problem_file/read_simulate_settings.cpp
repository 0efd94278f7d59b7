#include <fmt/format.h>

#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/tables.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;

/// A number, or an expression to be evaluated when the parameters are known.
mechanics::Text number_or_expression(const TomlValue& value, const std::string& where) {
  if (value.is_string() && !nearest_double(value.text)) return {value.text, value.place};
  return {fmt::format("{:.17g}", require_number(value, where)), value.place};
}

long require_samples(const TomlValue& value) {
  const double samples = require_number(value, "simulate.samples");
  constexpr double most = 1e8;
  if (!(samples >= 2 && samples <= most) || samples != static_cast<double>(static_cast<long>(samples)))
    throw InvalidInput("simulate.samples: " + shown(value.text) +
                           " is no number of rows; give an integer from 2 to 100000000",
                       value.place);
  return static_cast<long>(samples);
}

}  // namespace

Restitution read_restitution(const mechanics::Text& constraint, const TomlValue& value,
                             const std::string& where) {
  mechanics::Text e = number_or_expression(value, where);
  if (const auto number = nearest_double(e.text))
    require_restitution(*number, value.text, where, value.place);
  return {constraint.text, constraint.begin, where, std::move(e)};
}

SimulateSettings read_simulate_settings(const TomlValue& table) {
  require_known_keys(require_table(table, "simulate"), "simulate",
                     {"until", "method", "tolerance", "step", "restitution", "samples", "impact_law"});
  SimulateSettings settings;
  if (const TomlValue* until = table.find("until"))
    settings.until = number_or_expression(*until, "simulate.until");
  if (const TomlValue* method = table.find("method")) {
    settings.method = require_string(*method, "simulate.method");
    settings.method_place = method->place;
  }
  if (const TomlValue* tolerance = table.find("tolerance"))
    settings.tolerance = require_positive(*tolerance, "simulate.tolerance");
  if (const TomlValue* step = table.find("step")) settings.step = require_positive(*step, "simulate.step");
  if (const TomlValue* restitution = table.find("restitution")) {
    if (restitution->kind == TomlValue::Kind::table) {
      for (const TomlEntry& entry : restitution->table)
        settings.restitutions.push_back(read_restitution({entry.key, entry.place}, entry.value,
                                                         "simulate.restitution." + shown(entry.key)));
    } else {
      settings.restitutions.push_back(read_restitution({}, *restitution, "simulate.restitution"));
    }
  }
  if (const TomlValue* samples = table.find("samples")) settings.samples = require_samples(*samples);
  if (const TomlValue* law = table.find("impact_law")) {
    settings.impact_law = require_string(*law, "simulate.impact_law");
    settings.impact_law_place = law->place;
  }
  return settings;
}

}  // namespace cli::inline problem_files
