#pragma once

#include <string>
#include <vector>

#include "mechanics/expression/code.hpp"
#include "mechanics/expression/names.hpp"

namespace mechanics::expression {

/// Parentheses, signs, exponents, calls and indices may be nested this deep; long sums are not nested.
inline constexpr int deepest_nesting = 256;

/// What an expression may be made of.
enum class Vocabulary : std::uint8_t {
  system,      ///< everything
  parameters,  ///< parameters
  index,       ///< parameters and indices, as numbers
  state,       ///< parameters, indices and t, as numbers
  instant,     ///< parameters, as numbers: the t of a state
};

struct Scope {
  const Names* names = nullptr;
  Vocabulary vocabulary = Vocabulary::system;
  std::vector<std::string> indices;  ///< the indices of the key, by slot; "" where it has a number
};

/// sum := product {(+|-) product};  product := unary {(*|/) unary};  unary := (+|-) unary | power;
/// power := postfix [^ unary];  postfix := primary {'};
/// primary := number | name [[sum {, sum}]] | function(sum {, sum}) | sum(name in sum..sum {, …}, sum) |
/// (sum). InvalidInput, with the place, for everything else.
Code parse_expression(const Source& source, const Scope& scope);

/// f of a constraint: a - b for "a >= b" and "a = b", b - a for "a <= b".
struct Relation {
  Code f;
  bool two_sided = false;
};
Relation parse_relation(const Source& source, const Scope& scope);

/// One index of a key: a number (`name` empty), a name over `lower..upper`, or, if `whole`, over the family.
struct KeyIndex {
  std::string name;
  bool whole = false;
  Code lower, upper;  ///< a number is `lower`; they may use the indices before it
};

/// "x", "x[3]", "x[i]", "x[i in 1..N, 2]" — and, of a coordinate's declaration, "x[1..N]".
struct Key {
  const Source* source = nullptr;
  std::string name;
  std::vector<KeyIndex> indices;
  std::vector<std::string> index_names() const;
};

/// The name that a key begins with, and how many indices follow; it needs no other names to be known.
struct KeyName {
  std::string name;
  std::uint32_t indices = 0;
};
KeyName parse_key_name(const Source& source);

/// `declares_ranges`: the key is that of a coordinate's declaration.
Key parse_key(const Source& source, const Names& names, bool declares_ranges);

}  // namespace mechanics::expression
