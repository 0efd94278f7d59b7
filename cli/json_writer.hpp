#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "convex/vector.hpp"

namespace cli {

/// Writes one JSON value on one line. Numbers are the shortest digits that read back to the same double; an
/// infinite one is "inf" or "-inf".
class JsonWriter {
 public:
  JsonWriter& begin_object() { return open('{'); }
  JsonWriter& end_object() { return close('}'); }
  JsonWriter& begin_array() { return open('['); }
  JsonWriter& end_array() { return close(']'); }
  JsonWriter& key(std::string_view name);
  JsonWriter& value(double number);
  JsonWriter& value(convex::Index number);
  JsonWriter& value(int number) { return value(static_cast<convex::Index>(number)); }
  JsonWriter& value(bool truth);
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& null();

  /// An object with one number per name.
  JsonWriter& numbers(const std::vector<std::string>& names, const convex::Vector& x);
  /// An array of numbers.
  JsonWriter& numbers(const convex::Vector& x);
  const std::string& text() const { return text_; }

 private:
  JsonWriter& open(char bracket);
  JsonWriter& close(char bracket);
  void separate();
  void quote(std::string_view text);

  std::string text_;
  bool needs_comma_ = false;
};

}  // namespace cli
