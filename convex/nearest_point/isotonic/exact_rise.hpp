#pragma once

#include <functional>
#include <optional>

#include "convex/vector.hpp"

namespace convex::inline isotonic {

/// A coordinate of a string, and the row factor (q - q_below) >= bound that ties it to the one below; of the
/// first its floor, factor q >= bound.
struct StringMember {
  double mass, linear, factor, bound;
};
using StringMembers = std::function<StringMember(Index)>;

/// The sign of the slack of the row below member `middle` where the members first … middle - 1 move together
/// and middle … end - 1 do: of mean(middle … end - 1) - mean(first … middle - 1) in the coordinates y =
/// q - (sum of the bounds below). In fractions; none when factors that are no powers of two are too many.
std::optional<int> rise(const StringMembers&, Index first, Index middle, Index end);

/// The same where the members from `first`, the string's own, to `middle` - 1 stand on its floor.
std::optional<int> rise_over_floor(const StringMembers&, Index first, Index middle, Index end);

}  // namespace convex::inline isotonic
