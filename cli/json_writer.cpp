#include "cli/json_writer.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace cli {
namespace {

/// Bytes of the first character, 0 where they are no UTF-8 (RFC 3629, section 4).
std::size_t length_of_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80U) return 1;
  if (first < 0xc2U || first > 0xf4U) return 0;
  const std::size_t length = first < 0xe0U ? 2 : first < 0xf0U ? 3 : 4;
  if (text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
  const bool overlong = (first == 0xe0U && byte(1) < 0xa0U) || (first == 0xf0U && byte(1) < 0x90U);
  const bool no_character = (first == 0xedU && byte(1) > 0x9fU) || (first == 0xf4U && byte(1) > 0x8fU);
  return overlong || no_character ? 0 : length;
}

}  // namespace

void JsonWriter::separate() {
  if (needs_comma_) text_ += ',';
  needs_comma_ = true;
}

JsonWriter& JsonWriter::open(char bracket) {
  separate();
  text_ += bracket;
  needs_comma_ = false;
  return *this;
}

JsonWriter& JsonWriter::close(char bracket) {
  text_ += bracket;
  needs_comma_ = true;
  return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
  separate();
  quote(name);
  text_ += ':';
  needs_comma_ = false;
  return *this;
}

JsonWriter& JsonWriter::value(double number) {
  if (std::isinf(number)) return value(number > 0 ? "inf" : "-inf");
  if (std::isnan(number)) return null();
  separate();
  std::array<char, 32> digits{};
  const double positive_zero = number + 0.0;  // -0 is 0
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), positive_zero).ptr;
  text_.append(digits.data(), end);
  return *this;
}

JsonWriter& JsonWriter::value(convex::Index number) {
  separate();
  text_ += std::to_string(number);
  return *this;
}

JsonWriter& JsonWriter::value(bool truth) {
  separate();
  text_ += truth ? "true" : "false";
  return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) {
  separate();
  quote(text);
  return *this;
}

JsonWriter& JsonWriter::null() {
  separate();
  text_ += "null";
  return *this;
}

JsonWriter& JsonWriter::numbers(const std::vector<std::string>& names, const convex::Vector& x) {
  begin_object();
  for (std::size_t i = 0; i < names.size(); ++i) key(names[i]).value(x[static_cast<convex::Index>(i)]);
  return end_object();
}

JsonWriter& JsonWriter::numbers(const convex::Vector& x) {
  begin_array();
  for (convex::Index i = 0; i < x.size(); ++i) value(x[i]);
  return end_array();
}

void JsonWriter::quote(std::string_view text) {
  constexpr std::string_view replacement = "\ufffd";  // for what is no UTF-8, as names of files may be
  text_ += '"';
  while (!text.empty()) {
    const std::size_t length = length_of_character(text);
    const char c = text[0];
    const auto code = static_cast<unsigned char>(c);
    if (length != 1) {
      text_ += length == 0 ? replacement : text.substr(0, length);
    } else if (c == '"' || c == '\\') {
      text_ += '\\';
      text_ += c;
    } else if (code < 0x20U) {
      constexpr std::string_view hex = "0123456789abcdef";
      text_ += "\\u00";
      text_ += hex[code >> 4U];
      text_ += hex[code & 15U];
    } else {
      text_ += c;
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  text_ += '"';
}

}  // namespace cli
