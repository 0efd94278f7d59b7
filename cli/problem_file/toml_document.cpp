#include "cli/problem_file/toml_document.hpp"

#include <toml++/toml.h>
#include <algorithm>

#include "cli/problem_file/toml_slip.hpp"

namespace cli::inline problem_files {
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
        made.table.push_back({std::string(key.str()),
                              of_key(place(key.source().begin), std::string(key.str())), value(child)});
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
      made.content = content(made.place, made.text);
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

  /// Of a key: the place of its quotation mark, and behind its first character those of the others.
  mechanics::TextOrigin of_key(convex::Place at, const std::string& key) const {
    mechanics::TextOrigin made(at);
    const std::size_t i = offset(at);
    if (i >= text_.size() || (text_[i] != '"' && text_[i] != '\'')) return made;
    made.jumps.push_back({1, {at.line, at.column + 2}});
    for (const auto& jump : content(at, key).jumps) made.jumps.push_back(jump);
    return made;
  }

  mechanics::TextOrigin content(convex::Place at, const std::string& decoded) const {
    const std::size_t i = offset(at);
    const std::string quotes = text_.substr(i, 3);
    const bool is_basic = quotes[0] == '"', is_long = quotes == "\"\"\"" || quotes == "'''";
    const auto origin = [&](std::size_t begin, convex::Place place) {
      return is_basic ? behind_escapes(begin, place, decoded) : mechanics::TextOrigin(place);
    };
    if (!is_long) return origin(i + 1, {at.line, at.column + 1});
    const std::size_t first = i + 3;
    const std::size_t line_break = text_.compare(first, 1, "\n") == 0     ? 1
                                   : text_.compare(first, 2, "\r\n") == 0 ? 2
                                                                          : 0;
    return line_break > 0 ? origin(first + line_break, {at.line + 1, 1})
                          : origin(first, {at.line, at.column + 3});
  }

  /// Of the characters of a basic string, that begins at `i`, at `place`: it jumps behind each escape.
  mechanics::TextOrigin behind_escapes(std::size_t i, convex::Place place, const std::string& decoded) const {
    mechanics::TextOrigin made(place);
    const auto step = [&] {
      if (text_[i] == '\n') {
        ++place.line;
        place.column = 1;
      } else if ((static_cast<unsigned char>(text_[i]) & 0xC0U) != 0x80U) {
        ++place.column;
      }
      ++i;
    };
    for (std::size_t k = 0; k < decoded.size() && i < text_.size();) {
      if (text_[i] != '\\' || i + 1 >= text_.size()) {
        if (text_[i] != decoded[k] && text_[i] != '\r') break;  // not as it is understood here
        k += text_[i] == decoded[k] ? 1 : 0;
        step();
        continue;
      }
      const char escaped = text_[i + 1];
      const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
      if (is_blank(escaped)) {
        step();
        while (i < text_.size() && is_blank(text_[i])) step();
      } else {
        const int length = escaped == 'u' ? 6 : escaped == 'U' ? 10 : 2;
        for (int c = 0; c < length && i < text_.size(); ++c) step();
        for (++k; k < decoded.size() && (static_cast<unsigned char>(decoded[k]) & 0xC0U) == 0x80U;) ++k;
      }
      made.jumps.push_back({k, place});
    }
    return made;
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
    std::string what(error.description());
    if (const std::string advice = advice_on_slip(text, at, what); !advice.empty())
      throw convex::InvalidInput(advice, at);
    const std::string prefix = "Error while parsing ";
    if (what.rfind(prefix, 0) == 0) what = "cannot read " + what.substr(prefix.size());
    constexpr std::size_t longest = 200;
    if (what.size() > longest) what = what.substr(0, longest) + "…";
    for (char& c : what)
      if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
    throw convex::InvalidInput("not a TOML file: " + what + "; see docs/problem-files.md for the form", at);
  }
}

}  // namespace cli::inline problem_files
