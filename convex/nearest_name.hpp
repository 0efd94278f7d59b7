#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace convex {

/// The known name that an unknown one is a slip of, or ""; the first of equals. Slips are counted as letters
/// left out, put in, replaced, or two neighbours exchanged (Damerau 1964), upper and lower case alike; one is
/// forgiven for every three letters begun with the second, none to a single letter. The beginning of one name
/// alone, of three letters or more, stands for it; then a word of a name of several ("near-parallel") does.
std::string nearest_name(std::string_view unknown, const std::vector<std::string>& known);

/// What to write instead of an unknown name: "did you mean "x"?", or where nothing is near the names there
/// are, "known are x, y and 3 more" (`others` where there are many, as "`moreau functions` lists them").
std::string suggestion(std::string_view unknown, const std::vector<std::string>& known,
                       std::string_view others = "");

}  // namespace convex
