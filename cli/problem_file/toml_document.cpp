#include "cli/problem_file/toml_document.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <cctype>

namespace cli {
namespace {

class Converter {
 public:
  explicit Converter(const std::string& text) : text_(text) {
    line_starts_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') line_starts_.push_back(i + 1);
  }

  TomlValue value(const toml::node& node) const {
    TomlValue made;
    made.place = place(node.source().begin);
    made.content = made.place;
    if (const auto* table = node.as_table()) {
      made.kind = TomlValue::Kind::table;
      for (const auto& [key, child] : *table)
        made.table.push_back({std::string(key.str()), place(key.source().begin), value(child)});
      std::stable_sort(made.table.begin(), made.table.end(), [](const TomlEntry& a, const TomlEntry& b) {
        return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
      });
    } else if (const auto* array = node.as_array()) {
      made.kind = TomlValue::Kind::array;
      made.array.reserve(array->size());
      for (const toml::node& child : *array) made.array.push_back(value(child));
    } else if (const auto* string = node.as_string()) {
      made.kind = TomlValue::Kind::string;
      made.text = string->get();
      made.content = content(made.place);
    } else if (const auto* integer = node.as_integer()) {
      made.kind = TomlValue::Kind::integer;
      made.number = static_cast<double>(integer->get());
      made.text = std::to_string(integer->get());
    } else if (const auto* floating = node.as_floating_point()) {
      made.kind = TomlValue::Kind::floating;
      made.number = floating->get();
      made.text = written(node.source());
    } else if (const auto* boolean = node.as_boolean()) {
      made.kind = TomlValue::Kind::boolean;
      made.boolean = boolean->get();
    } else {
      made.kind = TomlValue::Kind::other;
    }
    return made;
  }

  static convex::Place place(const toml::source_position& position) {
    return {std::max(1, static_cast<int>(position.line)), std::max(1, static_cast<int>(position.column))};
  }

 private:
  /// The offset of a place in the text; columns count characters, not bytes. It is counted from the place
  /// asked for before when that is on the same line and not behind: a line may be millions of numbers long.
  std::size_t offset(convex::Place at) const {
    const std::size_t line = static_cast<std::size_t>(at.line - 1);
    if (at.line != before_.line || at.column < before_.column) {
      before_ = {at.line, 1};
      offset_before_ = line < line_starts_.size() ? line_starts_[line] : text_.size();
    }
    std::size_t i = offset_before_;
    for (int column = before_.column; column < at.column && i < text_.size(); ++column) {
      ++i;
      while (i < text_.size() && (static_cast<unsigned char>(text_[i]) & 0xC0U) == 0x80U) ++i;
    }
    before_ = at;
    offset_before_ = i;
    return i;
  }

  convex::Place content(convex::Place at) const {
    const std::size_t i = offset(at);
    const std::string quotes = text_.substr(i, 3);
    if (quotes != "\"\"\"" && quotes != "'''") return {at.line, at.column + 1};
    const std::size_t first = i + 3;
    const bool line_break = text_.compare(first, 1, "\n") == 0 || text_.compare(first, 2, "\r\n") == 0;
    return line_break ? convex::Place{at.line + 1, 1} : convex::Place{at.line, at.column + 3};
  }

  std::string written(const toml::source_region& region) const {
    const std::size_t first = offset(place(region.begin)), last = offset(place(region.end));
    std::string digits = text_.substr(first, last > first ? last - first : 0);
    std::erase(digits, '_');
    return digits;
  }

  const std::string& text_;
  std::vector<std::size_t> line_starts_;
  mutable convex::Place before_{0, 0};
  mutable std::size_t offset_before_ = 0;
};

/// The value that a place of the text is in, from its = or [ or comma to the end of the line or the next
/// comma or bracket; "" where there is none.
std::string value_around(const std::string& text, convex::Place at) {
  std::size_t begin = 0;
  for (int line = 1; line < at.line && begin != std::string::npos; ++line) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  if (begin == std::string::npos) return "";
  const std::string line = text.substr(begin, text.find_first_of("\r\n", begin) - begin);
  const std::size_t here = std::min(line.size(), static_cast<std::size_t>(at.column - 1));
  std::size_t first = here;
  // The = of a key has that key alone before it; that of a relation is part of its expression.
  const auto assigns = [&](std::size_t i) {
    if (line[i] != '=') return false;
    while (i > 0 && (std::isalnum(static_cast<unsigned char>(line[i - 1])) != 0 ||
                     std::string(" \t_-.\"[]").find(line[i - 1]) != std::string::npos))
      --i;
    return i == 0 || line[i - 1] == '{' || line[i - 1] == ',';
  };
  while (first > 0 && !assigns(first - 1) && line[first - 1] != ',' && line[first - 1] != '{' &&
         !(line[first - 1] == '[' && first > 1 && (line[first - 2] == ' ' || line[first - 2] == '=')))
    --first;
  std::size_t last = line.find_first_of(",}#", here);
  std::string value = line.substr(first, last == std::string::npos ? last : last - first);
  while (!value.empty() && value.front() == ' ') value.erase(0, 1);
  while (!value.empty() && (value.back() == ' ' || value.back() == ']')) value.pop_back();
  return value;
}

/// Whether it reads as an expression that lacks its quotation marks.
bool is_bare_expression(const std::string& value) {
  constexpr std::size_t longest = 80;
  if (value.empty() || value.size() > longest || value.find_first_of("\"\\") != std::string::npos)
    return false;
  const unsigned char first = static_cast<unsigned char>(value.front());
  return std::isalnum(first) != 0 || first == '-' || first == '+' || first == '(';
}

/// A key of more parts than this is refused before it is followed into the depth.
constexpr int most_key_parts = 64;

/// Counts the dots of keys (and numbers, which have one) outside strings and comments.
void require_shallow_keys(const std::string& text) {
  int dots = 0, line = 1;
  std::size_t line_start = 0;
  char quote = 0;
  bool triple = false, comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      line_start = i + 1;
      comment = false;
      dots = 0;
      if (!triple) quote = 0;
    } else if (comment) {
      continue;
    } else if (quote != 0) {
      if (c == '\\' && quote == '"')
        ++i;
      else if (c == quote && (!triple || text.compare(i, 3, std::string(3, quote)) == 0)) {
        i += triple ? 2 : 0;
        quote = 0;
        triple = false;
      }
    } else if (c == '"' || c == '\'') {
      quote = c;
      triple = text.compare(i, 3, std::string(3, c)) == 0;
      i += triple ? 2 : 0;
    } else if (c == '#') {
      comment = true;
    } else if (c == '=' || c == ',' || c == '{' || c == '}') {
      dots = 0;
    } else if (c == '.' && ++dots > most_key_parts) {
      throw convex::InvalidInput("a key of more than " + std::to_string(most_key_parts) +
                                     " parts; the keys of a problem file have at most three",
                                 convex::Place{line, static_cast<int>(i - line_start) + 1});
    }
  }
}

}  // namespace

const TomlValue* TomlValue::find(const std::string& key) const {
  for (const TomlEntry& entry : table)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

TomlValue parse_toml(const std::string& text) {
  require_shallow_keys(text);
  try {
    const toml::table document = toml::parse(text);
    return Converter(text).value(document);
  } catch (const toml::parse_error& error) {
    const convex::Place at = Converter::place(error.source().begin);
    const std::string value = value_around(text, at);
    if (is_bare_expression(value))
      throw convex::InvalidInput(
          "not a TOML value: " + value + "; put it in quotation marks, \"" + value + "\"", at);
    std::string what(error.description());
    const std::string prefix = "Error while parsing ";
    if (what.rfind(prefix, 0) == 0) what = "cannot read " + what.substr(prefix.size());
    constexpr std::size_t longest = 200;
    if (what.size() > longest) what = what.substr(0, longest) + "…";
    for (char& c : what)
      if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
    throw convex::InvalidInput("not a TOML file: " + what + "; see docs/problem-files.md for the form", at);
  }
}

}  // namespace cli
