#include "cli/problem_file/keys.hpp"

#include <algorithm>
#include <cmath>

#include "cli/problem_file/exact_number.hpp"
#include "convex/nearest_name.hpp"

namespace cli {

using convex::InvalidInput;

namespace {

/// What other programs and textbooks call a key.
struct OtherWord {
  const char* word;
  const char* key;
};
constexpr OtherWord other_words[] = {
    {"T", "kinetic"},
    {"kinetic_energy", "kinetic"},
    {"V", "potential"},
    {"U", "potential"},
    {"gravity", "potential"},
    {"potential_energy", "potential"},
    {"q", "coordinates"},
    {"variables", "coordinates"},
    {"dofs", "coordinates"},
    {"Q", "forces"},
    {"constants", "parameters"},
    {"params", "parameters"},
    {"contacts", "constraints"},
    {"f", "constraints"},
    {"functions", "definitions"},
    {"clearance", "looseness"},
    {"backlash", "looseness"},
    {"initial", "state"},
    {"initial_state", "state"},
    {"q0", "position"},
    {"x0", "position"},
    {"v0", "velocity"},
    {"time", "t"},
    {"t0", "t"},
    {"t_end", "until"},
    {"tend", "until"},
    {"duration", "until"},
    {"dt", "step"},
    {"e", "restitution"},
    {"tol", "tolerance"},
    {"eps", "tolerance"},
    {"solver", "method"},
    {"algorithm", "method"},
    {"M", "A"},
    {"H", "A"},
    {"P", "A"},
    {"G", "U"},
    {"equalities", "two_sided"},
    {"W", "metric"},
    {"function", "f"},
    {"rays", "generators"},
    {"name", "title"},
};

std::string advice_on_key(const std::string& unknown, const std::vector<std::string>& known) {
  for (const OtherWord& other : other_words)
    if (unknown == other.word && std::find(known.begin(), known.end(), other.key) != known.end())
      return "did you mean \"" + std::string(other.key) + "\"?";
  return convex::suggestion(unknown, known);
}

}  // namespace

std::string shown(const std::string& text) {
  constexpr std::size_t longest = 100;
  std::string shortened = text.size() > longest ? text.substr(0, longest) + "..." : text;
  for (char& c : shortened)
    if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
  return shortened;
}

void require_known_keys(const TomlValue& table, const std::string& where,
                        std::initializer_list<const char*> known) {
  for (const TomlEntry& entry : table.table) {
    const std::vector<std::string> names(known.begin(), known.end());
    if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
    throw InvalidInput("unknown key \"" + shown(entry.key) + "\"" +
                           (where.empty() ? "" : " in [" + where + "]") + "; " +
                           advice_on_key(entry.key, names),
                       entry.place);
  }
}

const TomlValue& require_table(const TomlValue& value, const std::string& where) {
  if (value.kind != TomlValue::Kind::table)
    throw InvalidInput(where + ": not a table; write [" + where + "] and its keys below it", value.place);
  return value;
}

const std::string& require_string(const TomlValue& value, const std::string& where) {
  if (!value.is_string())
    throw InvalidInput(where + ": not a string; put it into quotation marks", value.place);
  return value.text;
}

double require_number(const TomlValue& value, const std::string& where) {
  if (value.is_number() && std::isfinite(value.number)) return value.number;
  if (value.is_number())
    throw InvalidInput(where + ": " + shown(value.text) + " is not finite; give finite numbers", value.place);
  if (value.is_string())
    if (const auto number = nearest_double(value.text)) {
      if (std::isfinite(*number)) return *number;
      throw InvalidInput(where + ": " + shown(value.text) + " is too large for a double; choose other units",
                         value.place);
    }
  throw InvalidInput(
      where + ": not a number; give 2, 0.5, 1e-3 or an exact value in quotation marks, \"1/3\"", value.place);
}

double require_positive(const TomlValue& value, const std::string& where) {
  const double number = require_number(value, where);
  if (!(number > 0))
    throw InvalidInput(where + ": " + shown(value.text) + " is not positive; give a number > 0", value.place);
  return number;
}

double require_restitution(const TomlValue& value, const std::string& where) {
  const double e = require_number(value, where);
  if (!(e >= 0 && e <= 1))
    throw InvalidInput(
        where + ": " + shown(value.text) + " is not from 0 to 1; an impact keeps energy (1) or takes it (0)",
        value.place);
  return e;
}

}  // namespace cli
