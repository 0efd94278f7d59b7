#include "cli/problem_file/settings.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "cli/problem_file/keys.hpp"
#include "cli/problem_file/kinds.hpp"
#include "convex/nearest_name.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;

[[noreturn]] void refuse_setting(const Setting& setting, const std::string& message) {
  throw InvalidInput(setting.option + " " + shown(setting.key) + ": " + message);
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// "inf", "-nan", …, which the file itself would have as numbers that are not finite.
bool is_word_of_no_number(const std::string& text) {
  const std::string word = text.substr(text.find_first_not_of("+-") == 1 ? 1 : 0);
  return word == "inf" || word == "nan";
}

/// A number is one, lists, tables, quoted texts and truths are TOML, all else is an expression.
TomlValue value_of_text(const std::string& key, const std::string& text) {
  TomlValue value;
  char* end = nullptr;
  value.number = std::strtod(text.c_str(), &end);
  const bool has_digit = text.find_first_of("0123456789") != std::string::npos;
  if (*end == '\0' && has_digit && std::isfinite(value.number) &&
      text.find_first_of("xXpP") == std::string::npos) {
    value.kind =
        text.find_first_of(".eE") == std::string::npos ? TomlValue::Kind::integer : TomlValue::Kind::floating;
    value.text = text.front() == '+' ? text.substr(1) : text;
    return value;
  }
  if (text.find_first_of("[{\"'") == 0 || text == "true" || text == "false") {
    try {
      return parse_toml("value = " + text).table.front().value;
    } catch (const InvalidInput& error) {
      refuse_setting({key, {}}, error.what());
    }
  }
  if (is_word_of_no_number(text)) {
    value.kind = TomlValue::Kind::floating;
    value.text = text;
    return value;
  }
  value.kind = TomlValue::Kind::string;
  value.number = 0;
  value.text = text;
  return value;
}

/// The places of a setting are those of no file.
void forget_places(TomlValue& value) {
  value.place = value.content = {};
  for (TomlValue& entry : value.array) forget_places(entry);
  for (TomlEntry& entry : value.table) {
    entry.place = {};
    forget_places(entry.value);
  }
}

TomlValue* find(TomlValue& table, const std::string& key) {
  for (TomlEntry& entry : table.table)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

TomlValue& table_in(TomlValue& document, const std::string& key, const Setting& setting) {
  TomlValue* found = find(document, key);
  if (found == nullptr) {
    document.table.push_back({key, {}, {}});
    found = &document.table.back().value;
  }
  if (found->kind != TomlValue::Kind::table)
    refuse_setting(setting, "\"" + shown(key) + "\"" + " is no table here");
  return *found;
}

/// "z[2]": the third number of the list z.
TomlValue* entry_of_list(TomlValue& table, const std::string& key) {
  const std::size_t open = key.find('[');
  if (open == std::string::npos || key.back() != ']') return nullptr;
  TomlValue* value = find(table, key.substr(0, open));
  for (std::size_t at = open; value != nullptr && at < key.size();) {
    const std::size_t close = key.find(']', at);
    const std::string digits = key.substr(at + 1, close - at - 1);
    if (value->kind != TomlValue::Kind::array || digits.empty() || digits.size() > 9 ||
        digits.find_first_not_of("0123456789") != std::string::npos ||
        std::stoul(digits) >= value->array.size())
      return nullptr;
    value = &value->array[std::stoul(digits)];
    at = close + 1;
    if (at < key.size() && key[at] != '[') return nullptr;
  }
  return value;
}

/// "z[5]" of a list with fewer entries.
void require_no_list(TomlValue& table, const std::string& key, const Setting& setting) {
  if (key.back() != ']' || key.find('[') == std::string::npos) return;
  const std::string name = key.substr(0, key.find('['));
  const TomlValue* list = find(table, name);
  if (list == nullptr || list->kind != TomlValue::Kind::array) return;
  refuse_setting(setting, "there is no such entry; " + shown(name) + " has " +
                              std::to_string(list->array.size()) + ", counted from 0");
}

/// A key that stands in another table of the file, or a table itself.
void refuse_key_of_table(const TomlValue& system, const Setting& setting) {
  const std::string& key = setting.key;
  for (const char* name : {"definitions", "constraints"})
    if (const TomlValue* table = system.find(name); table != nullptr && table->find(key) != nullptr)
      refuse_setting(setting, std::string("this stands below ") + name + "; write " + name + "." + key);
  if (key == "method" || key == "tolerance")
    refuse_setting(setting,
                   "[solve] and [simulate] have one each; write solve." + key + " or simulate." + key);
  const std::string table = table_of_key(key);
  if (key == "position" || key == "velocity")
    refuse_setting(setting, "this is a table; write " + key + ".x for that of a coordinate x");
  if (!table.empty() && table != "system")
    refuse_setting(setting, "this stands below [" + table + "]; write " + table + "." + key);
}

/// What a key of one part stands for: a parameter, t, or a key of the table that the problem is.
std::string full_key(const TomlValue& document, const Setting& setting) {
  const std::string& key = setting.key;
  for (const char* content : {"system", "liquid"}) {
    const TomlValue* table = document.find(content);
    if (table == nullptr) continue;
    std::vector<std::string> known;
    if (const TomlValue* parameters = table->find("parameters"))
      for (const TomlEntry& entry : parameters->table) {
        if (entry.key == key) return std::string(content) + ".parameters." + key;
        known.push_back(entry.key);
      }
    if (key == "t" && document.find("state") != nullptr) return "state.t";
    if (table->find(key) != nullptr || key == "potential") return std::string(content) + "." + key;
    const TomlValue* state = document.find("state");
    const TomlValue* position = state == nullptr ? nullptr : state->find("position");
    if (position != nullptr && position->find(key) != nullptr)
      refuse_setting(setting, "this is a coordinate; write position." + key + " or velocity." + key);
    refuse_key_of_table(*table, setting);
    const std::string nearest = convex::nearest_name(key, known);
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    refuse_setting(setting,
                   "there is no such parameter; " + (!nearest.empty() ? "did you mean \"" + nearest + "\"?"
                                                     : known.empty()  ? "the file has none"
                                                                      : "the file has " + list));
  }
  for (const char* content : {"projection", "decomposition", "cone"})
    if (document.find(content) != nullptr) return std::string(content) + "." + key;
  if (document.find(key) == nullptr)
    refuse_setting(setting, "there is no such key; the file has no problem whose parameter it could be");
  return key;
}

/// A table whose name is a slip is why its keys are not found.
void require_names_of_tables(const TomlValue& document) {
  require_known_keys(document, "", top_keys);
  for (const ProblemKind& kind : problem_kinds)
    if (const TomlValue* table = document.find(kind.name)) require_known_keys(*table, kind.name, *kind.keys);
}

void apply_setting(TomlValue& document, const Setting& setting) {
  std::string path = setting.key;
  // A dot within brackets belongs to an index.
  const auto is_path = [&] { return path.substr(0, path.find('[')).find('.') != std::string::npos; };
  if (!is_path() && path != "title") path = full_key(document, setting);
  const std::string first = path.substr(0, path.find('.'));
  const bool of_state = first == "position" || first == "velocity";
  const bool of_system =
      first == "parameters" || first == "definitions" || first == "forces" || first == "constraints";
  if (of_state) path = "state." + path;
  if (of_system) path = (document.find("liquid") != nullptr ? "liquid." : "system.") + path;
  TomlValue* table = &document;
  for (;;) {
    const std::size_t dot = path.find('.'), bracket = path.find('[');
    if (dot == std::string::npos || bracket < dot) break;
    table = &table_in(*table, path.substr(0, dot), setting);
    path = path.substr(dot + 1);
  }
  TomlValue value = setting.value;
  forget_places(value);
  if (TomlValue* known = find(*table, path)) {
    value.place = known->place;
    value.content = known->content;
    *known = std::move(value);
  } else if (TomlValue* entry = entry_of_list(*table, path)) {
    *entry = std::move(value);
  } else {
    require_no_list(*table, path, setting);
    table->table.push_back({path, {}, std::move(value)});
  }
}

}  // namespace

Setting parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string key = trimmed(text.substr(0, equals));
  if (equals == std::string::npos || key.empty() || trimmed(text.substr(equals + 1)).empty())
    throw InvalidInput("--set " + shown(text) + ": no key and value; write --set \"m=3\"");
  return {key, value_of_text(key, trimmed(text.substr(equals + 1)))};
}

std::vector<Setting> parsed_settings(const std::vector<std::string>& texts) {
  std::vector<Setting> settings;
  for (const std::string& text : texts) settings.push_back(parse_setting(text));
  return settings;
}

Setting number_setting(const std::string& key, double value) {
  TomlValue number;
  number.kind = TomlValue::Kind::floating;
  number.number = value;
  number.text = fmt::format("{}", value);
  return {key, std::move(number), "--over"};
}

void apply_settings(TomlValue& document, const std::vector<Setting>& settings) {
  for (const Setting& setting : settings) try {
      apply_setting(document, setting);
    } catch (const InvalidInput&) {
      require_names_of_tables(document);
      throw;
    }
}

}  // namespace cli::inline problem_files
