#include "mechanics/expression/parser.hpp"

#include "mechanics/expression/parsing.hpp"

namespace mechanics::expression {

Code parse_expression(const Source& source, const Scope& scope) {
  return Parsing(source, scope).expression();
}

Relation parse_relation(const Source& source, const Scope& scope) {
  return Parsing(source, scope).relation();
}

KeyName parse_key_name(const Source& source) { return Parsing(source, Scope{}).key_name(); }

Key parse_key(const Source& source, const Names& names, bool declares_ranges) {
  return Parsing(source, Scope{&names, Vocabulary::index, {}}).key(declares_ranges);
}

std::vector<std::string> Key::index_names() const {
  std::vector<std::string> result;
  for (const KeyIndex& index : indices) result.push_back(index.name);
  return result;
}

}  // namespace mechanics::expression
