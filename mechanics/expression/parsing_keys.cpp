#include "mechanics/expression/parsing.hpp"

namespace mechanics::expression {
namespace {

constexpr std::uint32_t most_indices = 8;  // of one family; its place in an instruction is small

}  // namespace

KeyName Parsing::key_name() {
  const Token name = expect(Kind::name, "a name: letters, digits and _, not starting with a digit");
  if (token_.kind == Kind::end) return {std::string(name.text), 0};
  if (token_.kind != Kind::open_index) refuse_behind_name("the end of the name or \"[\"");
  std::uint32_t indices = 1;
  int open = 0;  // a comma inside brackets or parentheses separates no indices of this key
  for (advance(); token_.kind != Kind::end; advance()) {
    if (token_.kind == Kind::open || token_.kind == Kind::open_index) ++open;
    if (token_.kind == Kind::close || token_.kind == Kind::close_index) --open;
    if (token_.kind == Kind::comma && open == 0) ++indices;
  }
  if (indices > most_indices) source_->fail(0, "a family has at most 8 indices; use fewer");
  return {std::string(name.text), indices};
}

Key Parsing::key(bool declares_ranges) {
  Key key;
  mistakes_.gather([&] { key = named_key(declares_ranges); });
  mistakes_.tell();
  return key;
}

Key Parsing::named_key(bool declares_ranges) {
  Key key;
  key.source = source_;
  key.name = std::string(expect(Kind::name, "a name").text);
  if (accept(Kind::open_index)) {
    do {
      key.indices.push_back(key_index(declares_ranges));
      if (key.indices.back().name.empty()) scope_.emplace_back("", slots_++);
      key_slots_ = slots_;
    } while (accept(Kind::comma));
    expect(Kind::close_index, "an operator or \"]\"");
  }
  if (token_.kind != Kind::end) refuse_behind_name("the end of the name");
  return key;
}

KeyIndex Parsing::key_index(bool declares_ranges) {
  KeyIndex index;
  const Token first = token_;
  const bool declared = at_index_declaration();
  if (declared) {
    advance();
    advance();
  } else if (!declares_ranges && first.kind == Kind::name &&
             (ahead_.kind == Kind::comma || ahead_.kind == Kind::close_index) && !is_reserved(first.text) &&
             !slot(first.text) && names_->find(first.text) == nullptr) {
    advance();  // an unknown name alone runs over the family
    declare_index(first);
    index.name = std::string(first.text);
    index.whole = true;
    return index;
  }
  index.lower = number_of_key();
  if (!declared && !declares_ranges) {
    if (token_.kind == Kind::range)
      source_->fail(first.offset, "this range has no index; write " + std::string("i in a..b"));
    return index;
  }
  if (token_.kind != Kind::range) unexpected("an operator or \"..\", as in x[1..N]");
  advance();
  index.upper = number_of_key();
  if (declared) {
    declare_index(first);
    index.name = std::string(first.text);
  } else {
    index.name = "(" + std::to_string(slots_) + ")";  // a range without a name; no expression can refer to it
    scope_.emplace_back("", slots_++);
  }
  return index;
}

Code Parsing::number_of_key() {
  sum();
  return take();
}

}  // namespace mechanics::expression
