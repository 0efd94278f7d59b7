#pragma once

#include <string>
#include <string_view>

#include "convex/invalid_input.hpp"

namespace cli::inline function_language {

/// A text in the call language and how far it has been read. Lines and columns are those of the file or
/// command line that the text stands in; columns count characters, not bytes.
class Cursor {
 public:
  /// `what` is the text's name for messages: "decomposition.f", "--at".
  Cursor(std::string_view text, std::string_view what, convex::Place begin)
      : text_(text), what_(what), place_(begin) {}

  convex::Place place() const { return place_; }
  bool at_end() const { return at_ == text_.size(); }
  /// The next byte, 0 at the end.
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  void advance(std::size_t bytes = 1);
  void skip_spaces();
  /// Takes the character and the spaces behind it, if it comes next.
  bool take(char expected);
  /// The longest run of letters, digits and _ from here on, taken; "" when a digit or no such byte is next.
  std::string_view take_name();
  /// The next character as it can be quoted in a message; "the end" at the end.
  std::string shown_next() const;

  /// Throws InvalidInput "what: message".
  [[noreturn]] void fail(const std::string& message, convex::Place place) const;
  [[noreturn]] void fail(const std::string& message) const { fail(message, place_); }

 private:
  std::string_view text_, what_;
  std::size_t at_ = 0;
  convex::Place place_;
};

/// The language is ASCII whatever the locale.
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool begins_name(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

}  // namespace cli::inline function_language
