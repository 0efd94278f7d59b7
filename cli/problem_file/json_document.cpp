#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "cli/problem_file/documents.hpp"
#include "cli/problem_file/keys.hpp"

namespace cli::inline problem_files {
namespace {

using convex::InvalidInput;
using convex::Place;
using Kind = TomlValue::Kind;

/// RFC 8259 by recursive descent.
class JsonReader {
 public:
  explicit JsonReader(const std::string& text) : text_(text) {}

  TomlValue document() {
    skip_space();
    if (peek() != '{') fail("no object { … } here");
    TomlValue found = value(0);
    skip_space();
    if (at_ < text_.size()) fail("more than one value");
    return found;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput("not a JSON file: " + what + "; see docs/problem-files.md for the form", place());
  }
  /// Columns count characters, not bytes.
  Place place() const { return {line_, static_cast<int>(at_ - line_start_ - behind_first_) + 1}; }
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void skip_space() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
        line_start_ = at_ + 1;
        behind_first_ = 0;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        return;
      }
    }
  }
  void expect(char c) {
    skip_space();
    if (peek() != c) fail(std::string("expected '") + c + "'");
    ++at_;
  }

  TomlValue value(int depth) {
    constexpr int deepest = 64;
    if (depth > deepest) fail("nested more than 64 deep");
    skip_space();
    TomlValue found;
    found.place = found.content = place();
    switch (peek()) {
      case '{':
        object(found, depth);
        return found;
      case '[':
        array(found, depth);
        return found;
      case '"':
        found.kind = Kind::string;
        std::tie(found.text, found.content) = string();
        return found;
      default:
        break;
    }
    for (const bool truth : {true, false}) {
      const std::string word = truth ? "true" : "false";
      if (text_.compare(at_, word.size(), word) != 0) continue;
      at_ += word.size();
      found.kind = Kind::boolean;
      found.boolean = truth;
      return found;
    }
    refuse_words();
    number(found);
    return found;
  }

  /// What JSON or Python write where there is no number.
  void refuse_words() const {
    for (const std::string_view word : {"null", "NaN", "Infinity", "-Infinity"})
      if (text_.compare(at_, word.size(), word) == 0)
        throw InvalidInput(
            key_ + ": " + std::string(word) + " is no value here; give a finite number, or leave the key out",
            place());
  }

  void object(TomlValue& to, int depth) {
    to.kind = Kind::table;
    ++at_;
    skip_space();
    if (peek() == '}') return void(++at_);
    do {
      skip_space();
      mechanics::TextOrigin where(place());
      if (peek() != '"') fail("expected a key in quotation marks");
      const auto [key, letters] = string();
      where.jumps.push_back({1, {where.line, where.column + 2}});
      where.jumps.insert(where.jumps.end(), letters.jumps.begin(), letters.jumps.end());
      if (to.find(key) != nullptr)
        throw InvalidInput("the key \"" + shown(key) + "\" stands here twice; keep one", where);
      expect(':');
      key_ = shown(key);
      to.table.push_back({key, where, value(depth + 1)});
    } while (comma_before('}'));
  }

  void array(TomlValue& to, int depth) {
    to.kind = Kind::array;
    ++at_;
    skip_space();
    if (peek() == ']') return void(++at_);
    do to.array.push_back(value(depth + 1));
    while (comma_before(']'));
  }

  bool comma_before(char close) {
    skip_space();
    const char c = peek();
    if (c != ',' && c != close) fail(std::string("expected ',' or '") + close + "'");
    ++at_;
    return c == ',';
  }

  void number(TomlValue& to) {
    const std::size_t first = at_;
    while (at_ < text_.size() && std::string_view("+-.0123456789eE").find(text_[at_]) != std::string::npos)
      ++at_;
    to.text = text_.substr(first, at_ - first);
    char* end = nullptr;
    to.number = std::strtod(to.text.c_str(), &end);
    if (to.text.empty() || *end != '\0' || to.text.find_first_of("0123456789") == std::string::npos) {
      at_ = first;
      fail("expected a value");
    }
    to.kind = to.text.find_first_of(".eE") == std::string::npos ? Kind::integer : Kind::floating;
  }

  unsigned code_unit() {
    if (at_ + 4 > text_.size()) fail("an escape is cut short");
    unsigned unit = 0;
    for (int k = 0; k < 4; ++k) {
      const char c = text_[at_];
      ++at_;
      const auto digit = std::string_view("0123456789abcdef").find(static_cast<char>(std::tolower(c)));
      if (digit == std::string_view::npos) fail("an escape without four hexadecimal digits");
      unit = unit * 16 + static_cast<unsigned>(digit);
    }
    return unit;
  }

  static void append(std::string& text, unsigned code) {
    const auto byte = [&](unsigned bits) { text += static_cast<char>(bits); };
    if (code < 0x80) {
      byte(code);
    } else if (code < 0x800) {
      byte(0xC0U | code >> 6U);
      byte(0x80U | (code & 0x3FU));
    } else if (code < 0x10000) {
      byte(0xE0U | code >> 12U);
      byte(0x80U | (code >> 6U & 0x3FU));
      byte(0x80U | (code & 0x3FU));
    } else {
      byte(0xF0U | code >> 18U);
      byte(0x80U | (code >> 12U & 0x3FU));
      byte(0x80U | (code >> 6U & 0x3FU));
      byte(0x80U | (code & 0x3FU));
    }
  }

  void escape(std::string& text) {
    const char c = peek();
    ++at_;
    const std::string_view names = "\"\\/bfnrt", meanings = "\"\\/\b\f\n\r\t";
    if (const std::size_t k = names.find(c); k != std::string_view::npos) return void(text += meanings[k]);
    if (c != 'u') fail("an unknown escape");
    unsigned code = code_unit();
    if (code >= 0xD800 && code < 0xDC00 && text_.compare(at_, 2, "\\u") == 0) {
      at_ += 2;
      code = 0x10000 + ((code - 0xD800) << 10U) + (code_unit() - 0xDC00);
    }
    append(text, code);
  }

  /// A text and where its characters stand: behind each escape it goes on elsewhere.
  std::pair<std::string, mechanics::TextOrigin> string() {
    std::string text;
    ++at_;
    mechanics::TextOrigin origin(place());
    while (at_ < text_.size() && text_[at_] != '"') {
      const char c = text_[at_];
      if (static_cast<unsigned char>(c) < 0x20U) fail("a text goes over its line");
      ++at_;
      if (c == '\\') {
        escape(text);
        origin.jumps.push_back({text.size(), place()});
      } else {
        text += c;
        if ((static_cast<unsigned char>(c) & 0xC0U) == 0x80U) ++behind_first_;
      }
    }
    if (at_ == text_.size()) fail("a text without end");
    ++at_;
    return {text, origin};
  }

  const std::string& text_;
  std::size_t at_ = 0, line_start_ = 0;
  std::size_t behind_first_ = 0;  ///< bytes of this line that continue a character
  int line_ = 1;
  std::string key_;  ///< the last one read
};

std::string quoted_json(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    constexpr const char* hexadecimal = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (byte < 0x20U) {
      out += "\\u00";
      out += hexadecimal[byte >> 4U];
      out += hexadecimal[byte & 15U];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

/// The digits of JSON: a digit on both sides of the point, no plus.
std::string json_number(const TomlValue& value) {
  if (!std::isfinite(value.number))
    throw InvalidInput("the number " + shown(value.text) + " cannot be held by .json; give a finite one",
                       value.place);
  std::string text = value.text;
  if (text.find_first_of("xob_") != std::string::npos)  // 0x1f, 0o17, 0b11
    return std::to_string(static_cast<long long>(value.number));
  if (text[0] == '+') text.erase(0, 1);
  return text;
}

void write_json(const TomlValue& value, int indent, std::string& out) {
  const std::string margin(static_cast<std::size_t>(2 * indent + 2), ' ');
  switch (value.kind) {
    case Kind::boolean:
      out += value.boolean ? "true" : "false";
      return;
    case Kind::integer:
    case Kind::floating:
      out += json_number(value);
      return;
    case Kind::string:
      out += quoted_json(value.text);
      return;
    case Kind::array:
      out += '[';
      for (std::size_t i = 0; i < value.array.size(); ++i) {
        if (i > 0) out += ", ";
        write_json(value.array[i], indent, out);
      }
      out += ']';
      return;
    case Kind::table:
      out += value.table.empty() ? "{" : "{\n";
      for (std::size_t i = 0; i < value.table.size(); ++i) {
        out += margin + quoted_json(value.table[i].key) + ": ";
        write_json(value.table[i].value, indent + 1, out);
        out += i + 1 < value.table.size() ? ",\n" : "\n" + margin.substr(2);
      }
      out += '}';
      return;
    default:
      throw InvalidInput("a date or time cannot be held by .json; take it out", value.place);
  }
}

}  // namespace

TomlValue parse_json(const std::string& text) { return JsonReader(text).document(); }

std::string json_text(const TomlValue& document) {
  std::string out;
  write_json(document, 0, out);
  return out + "\n";
}

}  // namespace cli::inline problem_files
