#include "cli/problem_file/toml_slip.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>

namespace cli::inline problem_files {
namespace {

/// Of a value in a message.
constexpr std::size_t longest_shown = 80;

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

bool is_of_key(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_-.\"'[]").find(c) != std::string_view::npos;
}

std::string without_spaces_around(std::string text) {
  while (!text.empty() && text.front() == ' ') text.erase(0, 1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.pop_back();
  return text;
}

/// The line of a place, and the value on it that the place is in.
struct Spot {
  std::string line;
  std::size_t here = 0;   ///< the place
  std::size_t first = 0;  ///< behind the = or [ or comma before it
  std::string value;      ///< from there to the next comma or bracket
};

/// The = of a key has that key alone before it; that of a relation is part of its expression.
bool assigns(const std::string& line, std::size_t i) {
  if (line[i] != '=') return false;
  while (i > 0 && (std::isalnum(static_cast<unsigned char>(line[i - 1])) != 0 ||
                   std::string(" \t_-.\"[]").find(line[i - 1]) != std::string::npos))
    --i;
  return i == 0 || line[i - 1] == '{' || line[i - 1] == ',';
}

Spot spot_of(const std::string& text, convex::Place at) {
  std::size_t begin = 0;
  for (int line = 1; line < at.line && begin != std::string::npos; ++line) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  if (begin == std::string::npos) return {};
  Spot spot{text.substr(begin, text.find_first_of("\r\n", begin) - begin), 0, 0, ""};
  const std::string& line = spot.line;
  spot.here = std::min(line.size(), static_cast<std::size_t>(at.column - 1));
  std::size_t& first = spot.first;
  first = spot.here;
  while (first > 0 && !assigns(line, first - 1) && line[first - 1] != ',' && line[first - 1] != '{' &&
         !(line[first - 1] == '[' && first > 1 && (line[first - 2] == ' ' || line[first - 2] == '=')))
    --first;
  const std::size_t last = line.find_first_of(",}#", spot.here);
  spot.value = without_spaces_around(line.substr(first, last == std::string::npos ? last : last - first));
  while (!spot.value.empty() && spot.value.back() == ']') spot.value.pop_back();
  return spot;
}

/// Whether it reads as an expression that lacks its quotation marks.
bool is_bare_expression(const std::string& value) {
  if (value.empty() || value.size() > longest_shown || value.find_first_of("\"\\") != std::string::npos)
    return false;
  const unsigned char first = static_cast<unsigned char>(value.front());
  return std::isalnum(first) != 0 || first == '-' || first == '+' || first == '(';
}

/// Whether another key and its = begin here, behind a comma, a semicolon or nothing.
bool begins_a_key(const std::string& rest) {
  std::size_t i = rest.find_first_not_of(" \t,;");
  if (i == std::string::npos || !(is_letter(rest[i]) || rest[i] == '"' || rest[i] == '_')) return false;
  while (i < rest.size() && is_of_key(rest[i])) ++i;
  i = rest.find_first_not_of(" \t", i);
  return i != std::string::npos && rest[i] == '=' && rest.compare(i, 2, "==") != 0;
}

/// Whether it is made of units, as "m/s^2" and "N*m": their symbols, powers, products and quotients.
bool is_unit(const std::string& text) {
  constexpr std::array<std::string_view, 26> symbols = {
      "m",  "mm", "cm", "km", "nm", "um",  "s",   "ms", "us", "min", "h",   "kg", "g",
      "mg", "t",  "N",  "kN", "Nm", "rad", "deg", "Hz", "Pa", "kPa", "bar", "J",  "W"};
  std::string symbol;
  const auto is_known = [&] {
    const bool known = symbol.empty() || std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
    symbol.clear();
    return known;
  };
  for (const char c : text) {
    if (is_letter(c)) {
      symbol += c;
      continue;
    }
    if (!is_known()) return false;
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 &&
        std::string_view(" */^-()").find(c) == std::string_view::npos)
      return false;
  }
  return is_known();
}

std::string advice_on_comma(const std::string& whole, const std::string& digits) {
  return digits.size() == 3 ? "a comma in a number; write " + whole + "." + digits + " or " + whole + digits
                            : "a decimal comma; write " + whole + "." + digits;
}

/// What stands behind a whole number or text, where the line should end.
std::string advice_on_rest(const std::string& token, const std::string& given) {
  if (begins_a_key(given)) return "two keys on a line; give each a line of its own, or join them in { }";
  const std::string rest = without_spaces_around(given);
  if (token.empty() || rest.empty()) return "";
  const char c = rest.front();
  if (rest.rfind("//", 0) == 0 || c == '%' || (c == ';' && token.front() != '"'))
    return "\"" + rest.substr(0, 2) + "\" begins no comment; write # before it";
  if (token.front() == '"') return "";
  const std::string behind = rest.substr(0, rest.find_first_of("#,}"));
  if (c == ',' && rest.size() > 1 && std::isdigit(static_cast<unsigned char>(rest[1])) != 0)
    return advice_on_comma(token, without_spaces_around(rest.substr(1)));
  if (is_letter(c) && (behind.find_first_of("*^()=<>+") == std::string::npos || is_unit(behind)))
    return token + " " + without_spaces_around(behind) + " is no number; write " + token +
           " with its unit in a comment, # " + without_spaces_around(behind) +
           ", or an expression in quotation marks";
  return "";
}

/// "2" and "e+": the digits of an exponent are missing.
std::string advice_on_exponent(const std::string& token, const std::string& rest) {
  const std::size_t sign = rest.size() > 1 && (rest[1] == '+' || rest[1] == '-') ? 1 : 0;
  const bool is_exponent = !rest.empty() && (rest[0] == 'e' || rest[0] == 'E') &&
                           std::string_view(" \t,]}#").find((rest + " ")[1 + sign]) != std::string_view::npos;
  return !is_exponent ? ""
                      : "the number " + token + rest.substr(0, 1 + sign) + " lacks its exponent; write " +
                            token + "e3, or " + token + " alone";
}

/// What the value is and what follows it, when it is a number or a text.
std::string advice_on_value(const Spot& spot) {
  const std::string from = without_spaces_around(spot.line.substr(spot.first));
  if (!from.empty() && from.front() == '"') {
    const std::size_t close = from.find('"', 1);
    return close == std::string::npos ? ""
                                      : advice_on_rest(from.substr(0, close + 1), from.substr(close + 1));
  }
  if (!from.empty() && from.front() == '\'' && from.find('\'', 1) != std::string::npos)
    return "the text in '…' ends at its first prime, as that of x'; write it in \"…\"";
  if (from.rfind("\xe2\x80\x9c", 0) == 0 || from.rfind("\xe2\x80\x9d", 0) == 0 ||
      from.rfind("\xe2\x80\x9e", 0) == 0)
    return "no quotation marks of TOML; write straight ones, \"";
  if (from.rfind("\xe2\x88\x92", 0) == 0 || from.rfind("\xe2\x80\x93", 0) == 0)
    return "no minus sign of TOML; write the hyphen, -";
  if (from.size() > 1 && from.front() == '.' && std::isdigit(static_cast<unsigned char>(from[1])) != 0)
    return "a number begins with a digit; write 0" + spot.value;
  char* end = nullptr;
  const double number = std::strtod(from.c_str(), &end);
  const auto length = static_cast<std::size_t>(end - from.c_str());
  const std::string token = from.substr(0, length);
  if (token.empty() || is_letter(token.front())) return "";
  if (std::isinf(number) && token.find_first_of("0123456789") != std::string::npos)
    return "the number " + token.substr(0, longest_shown) + " is too large for a double; choose other units";
  if (token.back() == '.' && without_spaces_around(from.substr(length)).empty())
    return "a number ends with a digit; write " + token + "0";
  if (const std::string advice = advice_on_exponent(token, from.substr(length)); !advice.empty())
    return advice;
  return advice_on_rest(token, from.substr(length));
}

/// "mu" of the small Greek letter at a place of a line, in UTF-8; "" where there is none.
std::string_view greek_letter(const std::string& line, std::size_t here) {
  constexpr std::array<std::string_view, 25> letters = {
      "alpha", "beta",   "gamma",   "delta", "epsilon", "zeta",    "eta",  "theta", "iota",
      "kappa", "lambda", "mu",      "nu",    "xi",      "omicron", "pi",   "rho",   "sigma",
      "sigma", "tau",    "upsilon", "phi",   "chi",     "psi",     "omega"};
  constexpr unsigned first = 0x3B1;  // of alpha; both forms of sigma follow each other
  if (here + 1 >= line.size()) return {};
  const auto lead = static_cast<unsigned char>(line[here]), rest = static_cast<unsigned char>(line[here + 1]);
  if ((lead & 0xE0U) != 0xC0U) return {};
  const unsigned code = (lead & 0x1FU) << 6U | (rest & 0x3FU);
  return code < first || code - first >= letters.size() ? std::string_view() : letters[code - first];
}

bool says(std::string_view description, std::string_view words) {
  return description.find(words) != std::string_view::npos;
}

/// "m" of "cannot redefine existing floating-point 'm'".
std::string name_in(std::string_view description) {
  const std::size_t first = description.find('\''), last = description.rfind('\'');
  return first == std::string_view::npos || last <= first + 1
             ? ""
             : std::string(description.substr(first + 1, last - first - 1));
}

/// The key in front of a place.
std::string key_before(const Spot& spot) {
  std::size_t end = spot.here;
  while (end > 0 && spot.line[end - 1] == ' ') --end;
  std::size_t begin = end;
  while (begin > 0 && is_of_key(spot.line[begin - 1])) --begin;
  return spot.line.substr(begin, end - begin);
}

/// { x = 0,5 }: what stands behind the comma is taken for a key, and is none.
std::string advice_on_key(const Spot& spot, const std::string& key) {
  const std::string number = without_spaces_around(spot.line.substr(0, spot.here));
  if (key.empty() || key.find_first_not_of("0123456789") != std::string::npos ||
      number.size() <= key.size() || number[number.size() - key.size() - 1] != ',')
    return "";
  const std::size_t comma = number.size() - key.size() - 1;
  std::size_t begin = comma;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(number[begin - 1])) != 0) --begin;
  if (begin > 0 && begin < comma && (number[begin - 1] == '-' || number[begin - 1] == '+')) --begin;
  return begin == comma ? "" : advice_on_comma(number.substr(begin, comma - begin), key);
}

/// "[state": the bracket is missing behind the name.
std::string advice_on_header(const std::string& line) {
  const std::size_t open = line.find('[');
  std::size_t end = open == std::string::npos ? line.size() : open + 1;
  const std::size_t begin = end;
  while (end < line.size() && (is_of_key(line[end]) || line[end] == ' ') && line[end] != '[') ++end;
  const std::string name = without_spaces_around(line.substr(begin, end - begin));
  return "the name of a table without its ]; write [" + (name.empty() ? "system.parameters" : name) + "]";
}

/// Of tables, lists and the = between a key and its value.
std::string advice_on_structure(const Spot& spot, std::string_view description) {
  if (says(description, "redefine existing table")) {
    const std::string name = name_in(description);
    return "the table [" + name + "] is there twice; put its keys into one";
  }
  if (says(description, "redefine existing"))
    return "the key " + name_in(description) + " is there twice; take one of them out";
  if (says(description, "dangling comma")) return "a comma behind the last entry of { }; take it out";
  if (says(description, "inline table: expected comma"))
    return "two entries of { } without a comma between them; write { x = 0.0, y = 0.0 }";
  const bool is_of_letters =
      spot.here < spot.line.size() && static_cast<unsigned char>(spot.line[spot.here]) >= 0x80;
  if (is_of_letters && (says(description, "inline table") || says(description, "root table") ||
                        says(description, "expected '='"))) {
    const std::string_view greek = greek_letter(spot.line, spot.here);
    return "a key with a letter beyond a to z; " +
           (greek.empty() ? "spell it with the letters a to z and A to Z, digits and _"
                          : "names have none, write " + std::string(greek));
  }
  if (says(description, "inline table")) return "no } closes this {; a table in { } stands on one line";
  if (says(description, "array: expected comma"))
    return "a list without its ], or two entries without a comma between them; write [1, 2]";
  if (says(description, "table header: expected ']'")) return advice_on_header(spot.line);
  if (says(description, "control characters other than TAB") || says(description, "string: encountered end"))
    return "a text without its closing quotation mark; add it";
  if (!says(description, "expected '='")) return "";
  const std::string key = key_before(spot);
  if (const std::string advice = advice_on_key(spot, key); !advice.empty()) return advice;
  if (says(description, "saw ':'")) return "a colon between a key and its value; write " + key + " = …";
  if (says(description, "saw '''"))
    return "a key has no prime; velocities are named as their coordinates, velocity = { x = 1.0 }";
  const std::size_t equals = spot.line.find('=', spot.here);
  if (equals != std::string::npos && spot.line[spot.here] == '[')
    return "a bracket in a key; put the key into quotation marks, \"" +
           without_spaces_around(spot.line.substr(0, equals)) + "\" = …";
  if (equals != std::string::npos)
    return "a key of several words; join them with _, or put the key in quotation marks";
  return "no = between a key and its value; write " + key + " = …";
}

}  // namespace

std::string advice_on_slip(const std::string& text, convex::Place place, std::string_view description) {
  if (says(description, "root table") && says(description, "saw '%'"))
    return "\"%\" begins no comment; write # before it";
  if (says(description, "root table") && says(description, "saw '{'"))
    return "this is JSON, not TOML; name the file .json";
  if (says(description, "utf-8")) return "no text in UTF-8; save the file as UTF-8 and not, say, as UTF-16";
  if (says(description, "after '\\r'"))
    return "a line that ends with a carriage return alone; save the file with line ends of Unix or Windows";
  const Spot spot = spot_of(text, place);
  std::string advice = advice_on_structure(spot, description);
  if (advice.empty()) advice = advice_on_value(spot);
  if (!advice.empty()) return advice;
  if (spot.value == "True" || spot.value == "False")
    return "\"" + spot.value + "\" is written small; write " + (spot.value == "True" ? "true" : "false");
  if (spot.value.size() > 1 && spot.value.back() == '"' &&
      std::count(spot.value.begin(), spot.value.end(), '"') == 1)
    return "a text without its opening quotation mark; write \"" + spot.value;
  if (spot.value.starts_with('(') && spot.value.find(" = ") != std::string::npos)
    return "a table stands in braces; write { x = 0.0, y = 0.0 }";
  if (!is_bare_expression(spot.value)) return "";
  return "not a TOML value: " + spot.value + "; put it in quotation marks, \"" + spot.value + "\"";
}

}  // namespace cli::inline problem_files
