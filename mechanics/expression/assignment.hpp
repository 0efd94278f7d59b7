#pragma once

#include <vector>

#include "mechanics/expression/expansion.hpp"

namespace mechanics::expression {

/// The tuples of a key's members, flat, in lexicographic order; `family` is what its bare indices run over,
/// or null. More than most_members, bounds that are no integers: InvalidInput, before anything is allocated.
std::vector<std::int64_t> tuples(const Key& key, const Members* family, Expansion& expansion);

/// A member given explicitly overrides a restricted range, which overrides the full family.
enum class Rank : std::uint8_t { family, range, member };
Rank rank(const Key& key);

/// Which entry each coordinate gets its expression from; no_entry where none does.
struct Assignment {
  std::vector<Entry> entries;
  std::vector<std::uint32_t> entry_of;
};

/// `keys` and values as texts (forces, positions, velocities); `table` names them in messages: "forces".
/// What a key of a table over coordinates is about. Throws InvalidInput where it is no coordinate, or has
/// other indices.
const Name& coordinate_named(const Key& key, const Names& names);

Assignment assign_to_coordinates(const std::vector<NamedText>& texts, const std::string& table,
                                 const std::string& value_of, const Names& names,
                                 const std::vector<Family>& coordinates, Vocabulary vocabulary,
                                 Sources& sources, Expansion& expansion);

/// The members that the entries of one family define together, and the entry of each.
struct Defined {
  Members members;
  std::vector<std::uint32_t> entry_of;  ///< by member, into `entries`
};
Defined define(const std::vector<Entry>& entries, const std::vector<std::uint32_t>& chosen,
               Expansion& expansion);

}  // namespace mechanics::expression
