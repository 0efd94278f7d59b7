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
  convex::Mistakes mistakes;
  mistakes.gather([&] {
    require_known_keys(require_table(table, "simulate"), "simulate",
                       {"until", "method", "tolerance", "step", "restitution", "samples", "impact_law"});
  });
  SimulateSettings settings;
  const auto read = [&](const char* key, const auto& work) {
    if (const TomlValue* value = table.find(key)) mistakes.gather([&] { work(*value); });
  };
  read("until",
       [&](const TomlValue& until) { settings.until = number_or_expression(until, "simulate.until"); });
  read("method", [&](const TomlValue& method) {
    settings.method = require_string(method, "simulate.method");
    settings.method_place = method.place;
  });
  read("tolerance", [&](const TomlValue& tolerance) {
    const char* where = "simulate.tolerance";
    settings.tolerance = require_positive(tolerance, where);
    settings.tolerance_place = tolerance.place;
    require_step_tolerance(*settings.tolerance, tolerance.text, where, tolerance.place);
  });
  read("step", [&](const TomlValue& step) {
    settings.step = require_positive(step, "simulate.step");
    settings.step_place = step.place;
  });
  read("restitution", [&](const TomlValue& e) {
    if (e.kind != TomlValue::Kind::table)
      return settings.restitutions.push_back(read_restitution({}, e, "simulate.restitution"));
    for (const TomlEntry& entry : e.table)
      mistakes.gather([&] {
        settings.restitutions.push_back(read_restitution({entry.key, entry.place}, entry.value,
                                                         "simulate.restitution." + shown(entry.key)));
      });
  });
  read("samples", [&](const TomlValue& samples) { settings.samples = require_samples(samples); });
  read("impact_law", [&](const TomlValue& law) {
    settings.impact_law = require_string(law, "simulate.impact_law");
    settings.impact_law_place = law.place;
  });
  mistakes.tell();
  return settings;
}

}  // namespace cli::inline problem_files
