#include "cli/function_language/cursor.hpp"

#include <algorithm>

namespace cli::inline function_language {
namespace {

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

void Cursor::advance(std::size_t bytes) {
  for (const std::size_t end = std::min(at_ + bytes, text_.size()); at_ < end; ++at_) {
    if (text_[at_] == '\n') {
      ++place_.line;
      place_.column = 1;
    } else if (!continues_character(text_[at_])) {
      ++place_.column;
    }
  }
}

void Cursor::skip_spaces() {
  while (peek() == ' ' || peek() == '\t' || peek() == '\n' || peek() == '\r') advance();
}

bool Cursor::take(char expected) {
  if (at_end() || peek() != expected) return false;
  advance();
  skip_spaces();
  return true;
}

std::string_view Cursor::take_name() {
  const std::size_t begin = at_;
  if (!begins_name(peek())) return {};
  std::size_t length = 1;
  while (begins_name(peek(length)) || is_digit(peek(length))) ++length;
  advance(length);
  return text_.substr(begin, length);
}

std::string Cursor::shown_next() const {
  if (at_end()) return "the end";
  if (static_cast<unsigned char>(peek()) < 0x20U || peek() == 0x7F) return "a control character";
  std::size_t length = 1;
  while (at_ + length < text_.size() && continues_character(text_[at_ + length])) ++length;
  return "\"" + std::string(text_.substr(at_, length)) + "\"";
}

void Cursor::fail(const std::string& message, convex::Place place) const {
  throw convex::InvalidInput(std::string(what_) + ": " + message, place);
}

}  // namespace cli::inline function_language
