#include "mechanics/expression/parser.hpp"

#include <algorithm>

#include "mechanics/expression/parsing.hpp"
#include "mechanics/expression/unknown_function.hpp"

namespace mechanics::expression {
namespace {

/// The name of a key, before its indices, has no letters beyond a to z, and no hyphens and points.
void require_plain_name(const Source& source) {
  const std::string_view text = source.text.text;
  const std::string_view name = text.substr(0, text.find('['));
  const auto is_strange = [](char c) {
    return static_cast<unsigned char>(c) >= 0x80U || c == '-' || c == '.';
  };
  const auto at = static_cast<std::size_t>(std::find_if(name.begin(), name.end(), is_strange) - name.begin());
  if (at == name.size()) return;
  const std::string_view character = character_at(name, at);
  const std::string word = instead_of_character(character);
  const bool is_word = word.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos;
  source.fail(at,
              quoted(character) + " is no letter of a name; " +
                  (is_word ? "write " + word : "spell it with the letters a to z and A to Z, digits and _"));
}

}  // namespace

Code parse_expression(const Source& source, const Scope& scope) {
  return Parsing(source, scope).expression();
}

Relation parse_relation(const Source& source, const Scope& scope) {
  return Parsing(source, scope).relation();
}

KeyName parse_key_name(const Source& source) {
  require_plain_name(source);
  return Parsing(source, Scope{}).key_name();
}

Key parse_key(const Source& source, const Names& names, bool declares_ranges) {
  require_plain_name(source);
  return Parsing(source, Scope{&names, Vocabulary::index, {}}).key(declares_ranges);
}

std::vector<std::string> Key::index_names() const {
  std::vector<std::string> result;
  for (const KeyIndex& index : indices) result.push_back(index.name);
  return result;
}

}  // namespace mechanics::expression
