#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace convex {

/// The known name with the least edit distance (Levenshtein) to an unknown one, the first of equals, when
/// that distance is at most `farthest`; else "".
std::string nearest_name(std::string_view unknown, const std::vector<std::string>& known,
                         std::size_t farthest = 64);

}  // namespace convex
