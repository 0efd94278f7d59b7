#include <cmath>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/numbers.hpp"
#include "cli/problem_file/tables.hpp"

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
    throw InvalidInput("liquid." + key + ": " + std::to_string(found.size()) + " expressions; give " +
                           std::to_string(n) + ", one a coordinate",
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

const TomlValue& required(const TomlValue& table, const std::string& key, const char* example) {
  const TomlValue* value = table.find(key);
  if (value == nullptr) throw InvalidInput("liquid." + key + ": missing; write " + example, table.place);
  return *value;
}

}  // namespace

LiquidProblem read_liquid(const TomlValue& table) {
  constexpr std::size_t most_coordinates = 3;
  require_known_keys(table, "liquid",
                     {"coordinates", "domain", "density", "velocity", "force", "free", "walls", "cells",
                      "low", "high", "symmetry", "parameters"});
  LiquidText text;
  const TomlValue& names = required(table, "coordinates", "coordinates = [\"x\", \"y\"]");
  for (const TomlValue& name : require_array(names, "liquid.coordinates").array)
    text.coordinates.push_back({require_string(name, "liquid.coordinates"), name.content});
  const std::size_t n = text.coordinates.size();
  if (n < 1 || n > most_coordinates)
    throw InvalidInput("liquid.coordinates: " + std::to_string(n) + " of them; give one, two or three",
                       names.place);
  const TomlValue& domain = required(table, "domain", "domain = \"disc(center=[0, 0], radius=1)\"");
  text.domain = {require_string(domain, "liquid.domain"), domain.content};
  text.density = liquid_expression(required(table, "density", "density = 1000"), "liquid.density");
  text.velocity = components(table, "velocity", n);
  text.force = components(table, "force", n);
  text.free = parts(table, "free", "pressure");
  text.walls = parts(table, "walls", "acceleration");
  text.low = components(table, "low", n);
  text.high = components(table, "high", n);
  if (const TomlValue* cells = table.find("cells")) text.cells = cell_count(*cells);
  if (const TomlValue* symmetry = table.find("symmetry"))
    text.symmetry = {require_string(*symmetry, "liquid.symmetry"), symmetry->content};
  if (const TomlValue* parameters = table.find("parameters"))
    for (const TomlEntry& entry : require_table(*parameters, "liquid.parameters").table)
      text.parameters.push_back({{entry.key, entry.place},
                                 liquid_expression(entry.value, "liquid.parameters." + shown(entry.key))});
  return {std::move(text)};
}

}  // namespace cli::inline problem_files
