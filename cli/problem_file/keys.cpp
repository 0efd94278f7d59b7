#include "cli/problem_file/keys.hpp"

#include <algorithm>
#include <cmath>

#include "cli/problem_file/exact_number.hpp"
#include "cli/problem_file/kinds.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline problem_files {

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
    {"body", "bodies"},
    {"rigid_bodies", "bodies"},
    {"simulation", "simulate"},
};

/// The table that a key belongs to; "" for a table by itself.
constexpr OtherWord homes[] = {
    {"coordinates", "system"},
    {"kinetic", "system"},
    {"potential", "system"},
    {"parameters", "system"},
    {"definitions", "system"},
    {"forces", "system"},
    {"constraints", "system"},
    {"looseness", "system"},
    {"position", "state"},
    {"velocity", "state"},
    {"in_contact", "state"},
    {"solve_for", "state"},
    {"until", "simulate"},
    {"samples", "simulate"},
    {"step", "simulate"},
    {"restitution", "simulate"},
    {"impact_law", "simulate"},
    {"contact_tolerance", "solve"},
    {"points", "draw"},
    {"segments", "draw"},
    {"circles", "draw"},
    {"state", ""},
    {"solve", ""},
    {"simulate", ""},
    {"draw", ""},
    {"bodies", ""},
};

/// What there is not here, and what is done about it.
constexpr OtherWord not_here[] = {
    {"friction", "contacts have no friction here; a force along a surface goes into [system.forces]"},
    {"mu", "contacts have no friction here; a force along a surface goes into [system.forces]"},
    {"damping", "write it as a force, [system.forces] x = \"-c*x'\""},
    {"stiffness", "write it into the potential, potential = \"k/2*x^2\""},
    {"lagrangian", "give T and V apart, kinetic = and potential ="},
    {"L", "give T and V apart, kinetic = and potential ="},
    {"mass", "write it into the kinetic energy, kinetic = \"m/2*x'^2\", m below [system.parameters]"},
    {"masses", "write them into the kinetic energy, kinetic = \"m/2*x'^2\", m below [system.parameters]"},
};

/// The key that another word is for, or "".
std::string key_of_word(const std::string& word, const std::vector<std::string>& known) {
  for (const OtherWord& other : other_words)
    if (word == other.word && std::find(known.begin(), known.end(), other.key) != known.end())
      return other.key;
  return "";
}

/// The key of another table that an unknown one is a slip of, or another word for.
const OtherWord* nearest_home(const std::string& unknown) {
  std::vector<std::string> words;
  for (const OtherWord& home : homes) words.emplace_back(home.word);
  std::string meant = key_of_word(unknown, words);
  if (meant.empty()) meant = convex::nearest_name(unknown, words);
  for (const OtherWord& home : homes)
    if (meant == home.word) return &home;
  return nullptr;
}

/// "[system.forces]", "[state]".
std::string table_of(const OtherWord& home) {
  const std::string outer = home.key;
  return "[" + outer + (outer.empty() ? "" : ".") + home.word + "]";
}

/// The table that a key at the top of a document belongs to; "" where it belongs to none.
std::string home_at_top(const std::string& key, const TomlValue& document) {
  const ProblemKind* kind = kind_of(document);
  return kind != nullptr && kind->has(key) ? kind->name : table_of_key(key);
}

std::string advice_on_home(const TomlEntry& entry, const std::string& home) {
  return entry.value.kind == TomlValue::Kind::table
             ? "it is a part of [" + home + "], write [" + home + "." + entry.key + "]"
             : "it belongs below [" + home + "]";
}

InvalidInput unknown_key(const TomlEntry& entry, const std::string& where, const std::string& advice) {
  return InvalidInput("unknown key \"" + shown(entry.key) + "\"" +
                          (where.empty() ? "" : " in [" + where + "]") + "; " + advice,
                      entry.place);
}

std::string advice_on_key(const TomlEntry& entry, const std::string& where,
                          const std::vector<std::string>& known) {
  const std::string& unknown = entry.key;
  const bool is_table = entry.value.kind == TomlValue::Kind::table;
  const bool is_of_system =
      where.empty() || where == "system" || where == "state" || where == "simulate" || where == "solve";
  for (const OtherWord& home : homes)
    if (is_of_system && unknown == home.word && where != home.key) {
      const std::string table(home.key);
      if (table.empty()) return "it is a table by itself, write [" + unknown + "]";
      return advice_on_home(entry, table);
    }
  for (const OtherWord& other : not_here)
    if (is_of_system && unknown == other.word) return other.key;
  if (const std::string key = key_of_word(unknown, known); !key.empty())
    return "did you mean \"" + key + "\"?";
  if (!convex::nearest_name(unknown, known).empty()) return convex::suggestion(unknown, known);
  if (where == "state" && !is_table)
    return "a coordinate's value stands in position = { " + shown(unknown) + " = … } or velocity";
  if (const OtherWord* home = is_of_system ? nearest_home(unknown) : nullptr; home != nullptr) {
    const bool is_key = !is_table && *home->key != '\0';
    return "did you mean " +
           (is_key ? "\"" + std::string(home->word) + "\" below [" + home->key + "]" : table_of(*home)) + "?";
  }
  return convex::suggestion(unknown, known);
}

/// Puts an entry into a table of a document, which is made where it is not there; over no other entry.
void put_into(TomlValue& document, const std::string& table, const TomlEntry& entry) {
  const auto is_it = [&](const TomlEntry& one) { return one.key == table; };
  auto to = std::find_if(document.table.begin(), document.table.end(), is_it);
  if (to == document.table.end()) {
    TomlValue made;
    made.place = entry.place;
    to = document.table.insert(to, TomlEntry{table, entry.place, std::move(made)});
  }
  const bool is_free = to->value.kind == TomlValue::Kind::table && to->value.find(entry.key) == nullptr;
  if (is_free) to->value.table.push_back(entry);
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
  convex::Mistakes mistakes;
  const std::vector<std::string> names(known.begin(), known.end());
  for (const TomlEntry& entry : table.table) {
    if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
    const std::string home = where.empty() ? home_at_top(entry.key, table) : "";
    mistakes.add(unknown_key(
        entry, where, home.empty() ? advice_on_key(entry, where, names) : advice_on_home(entry, home)));
  }
  mistakes.tell();
}

TomlValue with_meant_keys(TomlValue table, std::initializer_list<const char*> known) {
  const std::vector<std::string> names(known.begin(), known.end());
  for (TomlEntry& entry : table.table) {
    if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
    std::string meant = key_of_word(entry.key, names);
    if (meant.empty()) meant = convex::nearest_name(entry.key, names);
    if (!meant.empty() && table.find(meant) == nullptr) entry.key = meant;
  }
  return table;
}

TomlValue with_keys_at_home(TomlValue document) {
  TomlValue kept = document;
  kept.table.clear();
  std::vector<TomlEntry> strays;
  for (const TomlEntry& entry : document.table)
    (home_at_top(entry.key, document).empty() ? kept.table : strays).push_back(entry);
  for (const TomlEntry& stray : strays) put_into(kept, home_at_top(stray.key, document), stray);
  return kept;
}

void move_strays_home(TomlValue& document, convex::Mistakes& mistakes) {
  const ProblemKind* kind = kind_of(document);
  const auto content = std::find_if(document.table.begin(), document.table.end(), [&](const TomlEntry& one) {
    return kind != nullptr && one.key == kind->name;
  });
  if (content == document.table.end()) return;
  std::vector<std::pair<std::string, TomlEntry>> strays;  // with the table that each belongs to
  for (TomlEntry& part : content->value.table) {
    if (part.key != "parameters" && part.key != "definitions" && part.key != "forces" &&
        part.key != "constraints")
      continue;
    std::erase_if(part.value.table, [&](const TomlEntry& entry) {
      const bool is_name = entry.value.is_string() || entry.value.is_number();
      const bool is_of_kind = kind->has(entry.key) && content->value.find(entry.key) == nullptr;
      const std::string home = is_of_kind ? kind->name : is_name ? "" : table_of_key(entry.key);
      if (home.empty() || (is_name && kind->keys != &system_keys)) return false;
      const std::string table = std::string(kind->name) + "." + part.key;
      mistakes.add(InvalidInput(
          table + "." + shown(entry.key) + ": this is of [" + home + "]; " +
              (is_of_kind ? "write it above [" + table + "]" + (is_name ? ", or take another name" : "")
                          : "write [" + home + "] above it"),
          entry.place));
      strays.emplace_back(home, entry);
      return true;
    });
  }
  for (TomlEntry& table : document.table) {
    const bool is_of_system =
        table.key == "system" || table.key == "state" || table.key == "simulate" || table.key == "solve";
    if (kind->keys != &system_keys || !is_of_system) continue;
    std::erase_if(table.value.table, [&](const TomlEntry& entry) {
      const std::string home = table_of_key(entry.key);
      if (home.empty() || home == table.key) return false;
      mistakes.add(unknown_key(entry, table.key, advice_on_home(entry, home)));
      strays.emplace_back(home, entry);
      return true;
    });
  }
  for (const auto& [home, stray] : strays) put_into(document, home, stray);
}

std::string table_of_key(const std::string& key) {
  for (const OtherWord& home : homes)
    if (key == home.word) return home.key;
  return "";
}

MeantTable::MeantTable(const TomlValue& given, const std::string& where,
                       std::initializer_list<const char*> known, convex::Mistakes& mistakes)
    : table_(&given) {
  if (mistakes.gather([&] { require_known_keys(given, where, known); })) return;
  meant_ = with_meant_keys(given, known);
  table_ = &meant_;
  for (const TomlEntry& entry : meant_.table)
    is_whole_ = is_whole_ && std::find(known.begin(), known.end(), entry.key) != known.end();
}

const TomlValue& require_table(const TomlValue& value, const std::string& where) {
  if (value.kind != TomlValue::Kind::table)
    throw InvalidInput(where + ": not a table; write [" + where + "] and its keys below it, as name = value",
                       value.place);
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

void require_step_tolerance(double tolerance, const std::string& text, const std::string& where,
                            std::optional<convex::Place> place) {
  if (!(tolerance > 0 && tolerance < 1))
    throw InvalidInput(
        where + ": " + shown(text) +
            " is not between 0 and 1; the error of a step is a part of what it moves, be it 1e-10",
        place);
}

void require_restitution(double e, const std::string& text, const std::string& where, convex::Place place) {
  if (!(e >= 0 && e <= 1))
    throw InvalidInput(
        where + ": " + shown(text) + " is not from 0 to 1; an impact keeps energy (1) or takes it (0)",
        place);
}

}  // namespace cli::inline problem_files
