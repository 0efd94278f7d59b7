#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

#include "mechanics/lagrangian_text.hpp"

namespace mechanics::expression {

/// A text and what it is to the user: "kinetic", "constraint floor", "parameter m".
struct Source {
  Text text;
  std::string what;
  std::uint32_t id = 0;

  /// Throws InvalidInput "what: message", placed at the character at `offset`.
  [[noreturn]] void fail(std::size_t offset, const std::string& message) const;
};

/// Where a subexpression was written.
struct Origin {
  std::uint32_t source = 0;
  std::uint32_t offset = 0;
};

/// All texts of one system; a Source stays where it is.
class Sources {
 public:
  const Source& add(Text text, std::string what);
  const Source& operator[](std::uint32_t id) const { return sources_[id]; }
  convex::Place place(Origin origin) const { return sources_[origin.source].text.at(origin.offset); }

 private:
  std::deque<Source> sources_;
};

/// The character that begins at `at`, all bytes of its UTF-8.
std::string_view character_at(std::string_view text, std::size_t at);

/// The text in quotes, shortened and without control characters, for a message.
std::string quoted(std::string_view text);

/// A count for a message: 10000000 is "1e+07".
std::string count_text(double count);

}  // namespace mechanics::expression
