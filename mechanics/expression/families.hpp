#pragma once

#include <limits>
#include <string>
#include <vector>

#include "mechanics/expression/members.hpp"
#include "mechanics/expression/parser.hpp"

namespace mechanics::expression {

/// The largest family or sum; a larger one is refused before anything is expanded.
inline constexpr double most_members = 1e7;

/// An indexed name, or a single thing. Its members are numbered from `first` among all of their kind.
struct Family {
  std::string name;
  Members members;
  std::uint32_t first = 0;
};

/// One key and the expression that it gives to its members.
struct Entry {
  Key key;
  Code value;
};

/// Which entry a member gets its expression from.
inline constexpr std::uint32_t no_entry = std::numeric_limits<std::uint32_t>::max();

}  // namespace mechanics::expression
