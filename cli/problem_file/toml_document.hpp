#pragma once

#include <string>
#include <vector>

#include "mechanics/lagrangian_text.hpp"

namespace cli::inline problem_files {

struct TomlEntry;

/// A value of a TOML document as plain data, with the place where it stands; tables keep the order of the
/// file.
struct TomlValue {
  enum class Kind { boolean, integer, floating, string, array, table, other };
  Kind kind = Kind::table;
  convex::Place place;            ///< of the value
  mechanics::TextOrigin content;  ///< of a string's first character, behind the quotation mark
  bool boolean = false;
  double number = 0;  ///< of an integer or a float
  std::string text;   ///< of a string; the digits as written of an integer or a float
  std::vector<TomlValue> array;
  std::vector<TomlEntry> table;

  bool is_number() const { return kind == Kind::integer || kind == Kind::floating; }
  bool is_string() const { return kind == Kind::string; }
  /// The value of a key, or null.
  const TomlValue* find(const std::string& key) const;
};

struct TomlEntry {
  std::string key;
  mechanics::TextOrigin place;  ///< of the key, its quotation mark if any; then where its characters stand
  TomlValue value;
};

/// Parses a TOML document. Throws InvalidInput with the place when it is not TOML, or not UTF-8.
TomlValue parse_toml(const std::string& text);

}  // namespace cli::inline problem_files
