#include <cmath>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/kinds.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/tables.hpp"
#include "convex/counted.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;
using mechanics::Text;
using mechanics::liquid::LiquidText;
using mechanics::liquid::PartText;

Text liquid_expression(const TomlValue& value, const std::string& where) {
  if (value.is_number() && !std::isfinite(value.number))
    throw InvalidInput(where + ": " + value.text + " is not finite; give a finite number", value.place);
  if (value.is_string() || value.is_number()) return {value.text, value.content};
  throw InvalidInput(
      where + ": neither an expression nor a number; give an expression in quotation marks, or a number",
      value.place);
}

/// One expression a coordinate, or none at all.
std::vector<Text> components(const TomlValue& table, const std::string& key, std::size_t n) {
  const TomlValue* value = table.find(key);
  if (value == nullptr) return {};
  std::vector<Text> found;
  for (const TomlValue& entry : require_array(*value, "liquid." + key).array)
    found.push_back(liquid_expression(entry, "liquid." + key));
  if (found.size() != n)
    throw InvalidInput("liquid." + key + ": " + convex::counted(found.size(), "expression", "expressions") +
                           "; give " + std::to_string(n) + ", one a coordinate",
                       value->place);
  return found;
}

std::vector<PartText> parts(const TomlValue& table, const std::string& key, const std::string& given) {
  std::vector<PartText> found;
  const TomlValue* value = table.find(key);
  if (value == nullptr) return found;
  for (const TomlEntry& entry : require_table(*value, "liquid." + key).table) {
    const std::string where = "liquid." + key + "." + shown(entry.key);
    const TomlValue& part = require_table(entry.value, where);
    require_known_keys(part, where, {"where", given.c_str()});
    const TomlValue *condition = part.find("where"), *amount = part.find(given);
    if (condition == nullptr)
      throw InvalidInput(
          where + ": no where; say which boundary points it has, where = \"true\" or \"y >= 0\"",
          entry.place);
    if (amount == nullptr)
      throw InvalidInput(where + ": no " + given + "; give it, a number or an expression in the coordinates",
                         entry.place);
    found.push_back({{entry.key, entry.place},
                     {require_string(*condition, where + ".where"), condition->content},
                     liquid_expression(*amount, where + "." + given)});
  }
  return found;
}

long cell_count(const TomlValue& value) {
  constexpr double most = 1e9;
  if (value.kind == TomlValue::Kind::integer && value.number >= 1 && value.number <= most)
    return static_cast<long>(value.number);
  throw InvalidInput("liquid.cells: " + shown(value.text) +
                         " is not an integer from 1 to 1e9; give the cells along the longest side",
                     value.place);
}

}  // namespace

LiquidProblem read_liquid(const TomlValue& given) {
  constexpr std::size_t most_coordinates = 3;
  convex::Mistakes mistakes;
  const MeantTable meant(given, "liquid", liquid_keys, mistakes);
  const TomlValue& table = meant.table();
  const auto read = [&](const char* key, const auto& work) {
    const TomlValue* value = table.find(key);
    return value != nullptr && mistakes.gather([&] { work(*value); });
  };
  std::string missing;
  for (const auto& [key, example] : {std::pair("coordinates", "coordinates = [\"x\", \"y\"]"),
                                     {"domain", "domain = \"disc(center=[0, 0], radius=1)\""},
                                     {"density", "density = 1000"}})
    if (table.find(key) == nullptr) missing += std::string(missing.empty() ? "" : ", ") + example;
  if (!missing.empty() && meant.is_whole())
    mistakes.add(InvalidInput("liquid: keys are missing; write " + missing, table.place));
  LiquidText text;
  const bool has_coordinates = read("coordinates", [&](const TomlValue& names) {
    for (const TomlValue& name : require_array(names, "liquid.coordinates").array)
      text.coordinates.push_back({require_string(name, "liquid.coordinates"), name.content});
    const std::size_t n = text.coordinates.size();
    if (n < 1 || n > most_coordinates)
      throw InvalidInput("liquid.coordinates: " + std::to_string(n) + " of them; give one, two or three",
                         names.place);
  });
  read("domain", [&](const TomlValue& domain) {
    text.domain = {require_string(domain, "liquid.domain"), domain.content};
  });
  read("density",
       [&](const TomlValue& density) { text.density = liquid_expression(density, "liquid.density"); });
  if (has_coordinates)
    for (const auto& [key, to] : {std::pair("velocity", &text.velocity),
                                  {"force", &text.force},
                                  {"low", &text.low},
                                  {"high", &text.high}}) {
      auto& values = *to;
      const std::string name = key;
      mistakes.gather([&] { values = components(table, name, text.coordinates.size()); });
    }
  mistakes.gather([&] { text.free = parts(table, "free", "pressure"); });
  mistakes.gather([&] { text.walls = parts(table, "walls", "acceleration"); });
  read("cells", [&](const TomlValue& cells) { text.cells = cell_count(cells); });
  read("symmetry", [&](const TomlValue& symmetry) {
    text.symmetry = {require_string(symmetry, "liquid.symmetry"), symmetry.content};
  });
  read("parameters", [&](const TomlValue& parameters) {
    for (const TomlEntry& entry : require_table(parameters, "liquid.parameters").table)
      mistakes.gather([&] {
        text.parameters.push_back({{entry.key, entry.place},
                                   liquid_expression(entry.value, "liquid.parameters." + shown(entry.key))});
      });
  });
  mistakes.tell();
  return {std::move(text)};
}

}  // namespace cli::inline problem_files
