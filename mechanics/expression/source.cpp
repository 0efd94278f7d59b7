#include "mechanics/expression/source.hpp"

#include <cstdio>

namespace mechanics::expression {

void Source::fail(std::size_t offset, const std::string& message) const {
  throw convex::InvalidInput(what + ": " + message, text.at(offset));
}

const Source& Sources::add(Text text, std::string what) {
  sources_.push_back({std::move(text), std::move(what), static_cast<std::uint32_t>(sources_.size())});
  return sources_.back();
}

std::string_view character_at(std::string_view text, std::size_t at) {
  std::size_t length = 1;
  while (at + length < text.size() && (static_cast<unsigned char>(text[at + length]) & 0xC0U) == 0x80U)
    ++length;
  return text.substr(at, length);
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 60;  // bytes; a message stays one line
  std::size_t end = std::min(text.size(), longest);
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  std::string shown = "\"";
  for (const char c : text.substr(0, end))
    shown += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? ' ' : c;
  if (end < text.size()) shown += "…";
  return shown + "\"";
}

std::string count_text(double count) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.15g", count);
  return digits;
}

}  // namespace mechanics::expression
