#pragma once

#include <initializer_list>
#include <optional>
#include <string>

#include "cli/problem_file/toml_document.hpp"
#include "convex/mistakes.hpp"

namespace cli::inline problem_files {

/// A text from a file as it can stand in a message: short, and without control characters.
std::string shown(const std::string& text);

/// Refuses the keys of the table that are not known, naming the nearest known ones. `where` is the table's
/// name for the message, "" at the top.
void require_known_keys(const TomlValue& table, const std::string& where,
                        std::initializer_list<const char*> known);

/// The table with the keys that an unknown one is a slip of, or another word for, in its place, where they
/// are missing: what stands behind it can be read, too.
TomlValue with_meant_keys(TomlValue table, std::initializer_list<const char*> known);

/// The document with the keys at its top that belong below a table of it ("constraints", "until") in that
/// table: what stands behind them can be read, too. A table that is not there is made.
TomlValue with_keys_at_home(TomlValue document);

/// Moves what stands below a table of names and belongs elsewhere, as "potential" below [system.parameters]
/// where [system] has none, or a table "position": a line with the name of its table is missing before it, or
/// stands too early. So are keys of one table of a mechanism within another, as "position" in [system]. Each
/// is added to the mistakes.
void move_strays_home(TomlValue& document, convex::Mistakes& mistakes);

/// The table of a mechanism's file that a key belongs to, "simulate" of "until"; "" of others.
std::string table_of_key(const std::string& key);

/// A table whose unknown keys have been added to the mistakes: itself, or with the keys that are meant.
class MeantTable {
 public:
  MeantTable(const TomlValue& given, const std::string& where, std::initializer_list<const char*> known,
             convex::Mistakes& mistakes);
  MeantTable(const MeantTable&) = delete;
  MeantTable& operator=(const MeantTable&) = delete;
  const TomlValue& table() const { return *table_; }
  bool are_known() const { return table_ != &meant_; }
  /// Is what is missing missing, and not under a key of which nothing is known?
  bool is_whole() const { return is_whole_; }

 private:
  TomlValue meant_;  // of a table with unknown keys alone: tables may be large
  const TomlValue* table_;
  bool is_whole_ = true;
};

/// The value as a table; otherwise InvalidInput.
const TomlValue& require_table(const TomlValue& value, const std::string& where);

/// The text of a string value; otherwise InvalidInput.
const std::string& require_string(const TomlValue& value, const std::string& where);

/// The finite number that a value stands for: an integer, a float, or a string with an exact value such as
/// "1/3".
double require_number(const TomlValue& value, const std::string& where);

/// A finite number greater than 0.
double require_positive(const TomlValue& value, const std::string& where);

/// Refuses an error of a step, which is relative to what a step moves, that is not 0 < tolerance < 1; `text`
/// is how it is written.
void require_step_tolerance(double tolerance, const std::string& text, const std::string& where,
                            std::optional<convex::Place> place);

/// Refuses a coefficient of restitution that is not 0 <= e <= 1; `text` is how it is written.
void require_restitution(double e, const std::string& text, const std::string& where, convex::Place place);

}  // namespace cli::inline problem_files
