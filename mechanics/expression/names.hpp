#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mechanics/expression/source.hpp"

namespace mechanics::expression {

/// What a name stands for: the `index`-th parameter, family of coordinates, of definitions or of constraints.
/// A family with `indices` = 0 is a single thing.
struct Name {
  enum class Kind : std::uint8_t { parameter, coordinate, definition, constraint };
  Kind kind = Kind::parameter;
  std::uint32_t index = 0;
  std::uint32_t indices = 0;
};

/// "a parameter", "a coordinate", …
std::string_view article_and_kind(Name::Kind kind);

/// The names of a system: one name, one thing.
class Names {
 public:
  /// A name that is already taken, or reserved, is InvalidInput at `offset` of `source`.
  void declare(std::string_view name, Name meaning, const Source& source, std::size_t offset);
  /// The same of a name that no text of the file has: no suggestion lists it.
  void declare_unlisted(std::string_view name, Name meaning, const Source& source, std::size_t offset);
  const Name* find(std::string_view name) const;
  /// "; did you mean x?", or what there is, among the names of the kinds, `also` and, where `language`,
  /// functions.
  std::string suggestion(std::string_view unknown, const std::vector<Name::Kind>& kinds,
                         const std::vector<std::string>& also, bool language) const;

 private:
  std::unordered_map<std::string, Name> meanings_;
  std::vector<std::string> in_order_;
};

/// pi, t, sum, in and those functions that no file may have as a name; the others are known by their
/// parenthesis.
bool is_reserved(std::string_view name);

}  // namespace mechanics::expression
